#include "rounded_line.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "traverse/simulation/route.hpp"

namespace traverse::simulation {

namespace {

std::string text_of(const Eigen::Vector2d& p) { return fmt::format("({:g}, {:g})", p.x(), p.y()); }

Eigen::Vector2d turned(const Eigen::Vector2d& v, double angle) {
  return Eigen::Rotation2Dd(angle) * v;
}

}  // namespace

RoundedLine::RoundedLine(const std::vector<Eigen::Vector2d>& points, bool closed, double radius) {
  const std::size_t n = points.size();
  const std::size_t legs = closed ? n : n - 1;
  const auto at = [&](std::size_t i) -> const Eigen::Vector2d& { return points[i % n]; };
  const auto leg = [&](std::size_t i) { return Eigen::Vector2d(at(i + 1) - at(i)); };
  for (std::size_t i = 0; i < legs; ++i) {
    if (leg(i).norm() > 0.01) continue;
    throw ImpossibleRoute("waypoints_m", "each point apart from the one before",
                          text_of(at(i)) + " again");
  }
  // Angle of the corner at the end of leg i, and what its arc takes from both legs.
  std::vector<double> angle(legs, 0), taken(legs, 0);
  for (std::size_t i = 0; i < legs; ++i) {
    if (!closed && i + 1 == legs) break;
    const Eigen::Vector2d in = leg(i).normalized();
    const Eigen::Vector2d out = leg((i + 1) % legs).normalized();
    angle[i] = std::atan2(in.x() * out.y() - in.y() * out.x(), in.dot(out));
    if (std::abs(angle[i]) > 0.95 * std::numbers::pi) {
      throw ImpossibleRoute("waypoints_m", "no turning back on the spot",
                            "the corner at " + text_of(at(i + 1)));
    }
    taken[i] = radius * std::tan(std::abs(angle[i]) / 2);
  }
  for (std::size_t i = 0; i < legs; ++i) {
    const double before = i > 0 ? taken[i - 1] : (closed ? taken[legs - 1] : 0);
    if (before + taken[i] <= leg(i).norm()) continue;
    throw ImpossibleRoute(
        "corner_radius_m",
        fmt::format("arcs that fit on the leg of {:.1f} m from {} to {}", leg(i).norm(),
                    text_of(at(i)), text_of(at(i + 1))),
        fmt::format("{:g} m, which takes {:.1f} m of it", radius, before + taken[i]));
  }
  for (std::size_t i = 0; i < legs; ++i) {
    const double before = i > 0 ? taken[i - 1] : (closed ? taken[legs - 1] : 0);
    const Eigen::Vector2d direction = leg(i).normalized();
    add(at(i) + before * direction, direction, leg(i).norm() - before - taken[i], 0);
    if (angle[i] == 0) continue;
    add(at(i + 1) - taken[i] * direction, direction, radius * std::abs(angle[i]),
        angle[i] > 0 ? 1 / radius : -1 / radius);
  }
}

void RoundedLine::add(const Eigen::Vector2d& start, const Eigen::Vector2d& direction, double length,
                      double curvature) {
  pieces_.push_back({length_, length, start, direction, curvature});
  length_ += length;
}

Eigen::Vector2d RoundedLine::at(double s) const {
  const auto after = std::upper_bound(pieces_.begin(), pieces_.end(), s,
                                      [](double value, const Piece& p) { return value < p.begin; });
  const Piece& piece = *std::prev(after == pieces_.begin() ? std::next(after) : after);
  const double along = s - piece.begin;
  if (piece.curvature == 0) return piece.start + along * piece.direction;
  // The chord of an arc: half its angle off the tangent.
  const double turn = along * piece.curvature;
  return piece.start +
         turned(piece.direction, turn / 2) * (2 * std::sin(turn / 2) / piece.curvature);
}

}  // namespace traverse::simulation
