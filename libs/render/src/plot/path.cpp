#include "plot/path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plot/markers.hpp"

namespace traverse::render {

namespace {

constexpr double kGapOfMedian = 5;
constexpr double kShortestGap = 0.5;  // seconds

double longest_step(const geometry::Trajectory& trajectory) {
  if (!trajectory.is_stamped() || trajectory.size() < 3) {
    return std::numeric_limits<double>::infinity();
  }
  std::vector<double> steps;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    steps.push_back(geometry::seconds_between(trajectory.stamp(i - 1), trajectory.stamp(i)));
  }
  return std::max(kShortestGap, kGapOfMedian * percentile(steps, 50));
}

const Eigen::Vector3d kGap = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());

}  // namespace

std::size_t Path::first_finite() const {
  const auto found = std::find_if(positions.begin(), positions.end(),
                                  [](const Eigen::Vector3d& p) { return p.allFinite(); });
  return static_cast<std::size_t>(found - positions.begin());
}

std::size_t Path::last_finite() const {
  const auto found = std::find_if(positions.rbegin(), positions.rend(),
                                  [](const Eigen::Vector3d& p) { return p.allFinite(); });
  return found == positions.rend() ? positions.size()
                                   : static_cast<std::size_t>(positions.rend() - found) - 1;
}

Path path_of(const geometry::Trajectory& trajectory) {
  const double longest = longest_step(trajectory);
  Path path;
  Eigen::Vector3d last = kGap;
  double distance = 0;
  const auto add = [&](const Eigen::Vector3d& position, std::size_t pose) {
    path.positions.push_back(position);
    path.distances.push_back(distance);
    path.poses.push_back(pose);
  };
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const Eigen::Vector3d& position = trajectory.pose(i).translation;
    if (i > 0 && trajectory.is_stamped() &&
        geometry::seconds_between(trajectory.stamp(i - 1), trajectory.stamp(i)) > longest) {
      add(kGap, i - 1);
    }
    if (!position.allFinite()) {
      add(kGap, i);
      continue;
    }
    if (last.allFinite()) distance += (position - last).norm();
    last = position;
    add(position, i);
  }
  return path;
}

Bounds bounds_of(const Path& path) {
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> z;
  for (const Eigen::Vector3d& p : path.positions) {
    x.push_back(p.x());
    y.push_back(p.y());
    z.push_back(p.z());
  }
  return {Range::of(x), Range::of(y), Range::of(z)};
}

std::vector<Point> seen_from_above(const Path& path, const PlotArea& area) {
  std::vector<Point> line;
  line.reserve(path.positions.size());
  for (const Eigen::Vector3d& p : path.positions) line.push_back(area.at(p.x(), p.y()));
  return line;
}

PlaceOnLine place_at(const std::vector<Point>& line, const std::vector<double>& distances,
                     double distance, double reach) {
  // The first finite point at or after the distance, and the one before it.
  auto after = static_cast<std::size_t>(
      std::lower_bound(distances.begin(), distances.end(), distance) - distances.begin());
  while (after < line.size() && !is_finite(line[after])) ++after;
  if (after >= line.size()) return {};
  std::size_t before = after;
  while (before > 0 && (before == after || !is_finite(line[before]))) --before;
  if (!is_finite(line[before])) before = after;

  PlaceOnLine place;
  const double span = distances[after] - distances[before];
  const double share = span > 0 ? std::clamp((distance - distances[before]) / span, 0.0, 1.0) : 0;
  place.at = line[before] + share * (line[after] - line[before]);
  const auto far_enough = [&](Point p) {
    return is_finite(p) && std::hypot(p.x - place.at.x, p.y - place.at.y) >= reach;
  };
  std::size_t ahead = after;
  while (ahead + 1 < line.size() && is_finite(line[ahead + 1]) && !far_enough(line[ahead])) ++ahead;
  std::size_t behind = before;
  while (behind > 0 && is_finite(line[behind - 1]) && !far_enough(line[behind])) --behind;
  const Point step = line[ahead] - line[behind];
  const double length = std::hypot(step.x, step.y);
  if (length > 0) place.direction = (1 / length) * step;
  return place;
}

void draw_path_marks(Canvas& canvas, const std::vector<Point>& line, const Path& path,
                     Colour colour) {
  if (path.empty()) return;
  const Point start = line[path.first_finite()];
  const Point end = line[path.last_finite()];
  const double reach = 4 * canvas.sizes().line;
  const double room = 11 * canvas.sizes().line;  // between marks, so that each can be read
  std::vector<Point> marks{start, end};
  for (int twentieth = 1; twentieth < 20; ++twentieth) {
    const PlaceOnLine place = place_at(line, path.distances, path.length() * twentieth / 20, reach);
    const bool crowded = std::any_of(marks.begin(), marks.end(), [&](Point mark) {
      return std::hypot(mark.x - place.at.x, mark.y - place.at.y) < room;
    });
    if (crowded || place.direction == Point{}) continue;
    marks.push_back(place.at);
    if (twentieth % 2 == 0) {
      draw_tick(canvas, place.at, place.direction, canvas.theme().text);
    } else {
      draw_arrow(canvas, place.at, place.direction, colour);
    }
  }
  draw_end(canvas, end, colour);
  draw_start(canvas, start, colour);
}

}  // namespace traverse::render
