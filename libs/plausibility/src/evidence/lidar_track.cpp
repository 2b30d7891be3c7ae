#include "evidence/lidar_track.hpp"

#include <algorithm>
#include <cmath>

#include "traverse/statistics/quantile.hpp"

namespace traverse::plausibility {

namespace {

constexpr std::size_t kPointsLookedAt = 1000;
constexpr std::size_t kFirstScans = 100;  // all of these
constexpr std::size_t kEvery = 10;        // of those after them
constexpr std::size_t kMaxScans = 4000;

bool is_absurd(float value) {
  const float size = std::abs(value);
  return size > 1e7F || (size != 0 && size < 1e-6F);
}

/// Numbers of points that are neighbours in storage are neighbours in space, and so alike; other
/// numbers of a point are not.
std::size_t columns_of(const sensors::LidarScan& scan) {
  constexpr std::size_t kWindows = 4;
  constexpr std::size_t kPointsOfWindow = 200;
  constexpr std::size_t kNumbers = 4;
  constexpr float kFar_m = 5;  // what differs by more is not alike
  constexpr std::array<std::size_t, 5> kDistances{3, 4, 5, 6, 7};
  if (scan.intensity.size() != scan.size() || scan.size() < 2 * kWindows * kPointsOfWindow)
    return 0;
  std::array<double, kDistances.size()> differences{};
  std::vector<float> stored;
  for (std::size_t window = 0; window < kWindows; ++window) {
    stored.clear();
    const std::size_t begin = (2 * window + 1) * scan.size() / (2 * kWindows);
    for (std::size_t i = begin; i < begin + kPointsOfWindow; ++i) {
      stored.insert(stored.end(), {scan.x[i], scan.y[i], scan.z[i], scan.intensity[i]});
    }
    for (std::size_t d = 0; d < kDistances.size(); ++d) {
      for (std::size_t i = 0; i + kDistances.back() < stored.size(); ++i) {
        const float difference = std::abs(stored[i + kDistances[d]] - stored[i]);
        differences[d] += difference < kFar_m ? difference : kFar_m;
      }
    }
  }
  const auto least = std::min_element(differences.begin(), differences.end());
  const std::size_t columns = kDistances[static_cast<std::size_t>(least - differences.begin())];
  // A point of another number of columns is told when its neighbours are twice as alike as any four
  // numbers; points in no order are alike at no distance.
  return columns == kNumbers || *least < 0.5 * differences[1] ? columns : 0;
}

ScanSummary summary_of(double t, const sensors::LidarScan& scan) {
  ScanSummary summary;
  summary.t = t;
  summary.points = scan.size();
  const std::size_t count = std::min(scan.size(), kPointsLookedAt);
  std::vector<double> ranges;
  std::array<std::vector<double>, 3> coordinates;
  for (std::size_t k = 0; k < count; ++k) {
    // By the golden ratio points are spread evenly and in step with nothing of a lidar's.
    const double place = 0.6180339887498949 * static_cast<double>(k);
    const auto i =
        static_cast<std::size_t>((place - std::floor(place)) * static_cast<double>(scan.size()));
    const Eigen::Vector3f p(scan.x[i], scan.y[i], scan.z[i]);
    ++summary.looked_at;
    if (!p.allFinite()) {
      ++summary.not_finite;
    } else if (p.isZero(0)) {
      ++summary.at_origin;
    } else {
      if (is_absurd(p.x()) || is_absurd(p.y()) || is_absurd(p.z())) ++summary.absurd;
      ranges.push_back(p.cast<double>().norm());
      for (int axis = 0; axis < 3; ++axis) {
        coordinates[static_cast<std::size_t>(axis)].push_back(p[axis]);
      }
    }
    if (!scan.time.empty() && std::isfinite(scan.time[i])) {
      const double time = scan.time[i];
      if (!summary.times_s) summary.times_s = {time, time};
      (*summary.times_s)[0] = std::min((*summary.times_s)[0], time);
      (*summary.times_s)[1] = std::max((*summary.times_s)[1], time);
    }
  }
  summary.columns = columns_of(scan);
  if (ranges.empty()) return summary;
  summary.range_p05_m = statistics::element_at_share(ranges, 0.05);
  summary.range_median_m = statistics::element_at_share(ranges, 0.5);
  summary.range_p95_m = statistics::element_at_share(ranges, 0.95);
  for (int axis = 0; axis < 3; ++axis) {
    auto values = coordinates[static_cast<std::size_t>(axis)];
    summary.centre[axis] = statistics::element_at_share(values, 0.5);
  }
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const Eigen::Vector3d p(coordinates[0][i], coordinates[1][i], coordinates[2][i]);
    ranges[i] = (p - summary.centre).norm();
  }
  summary.spread_m = statistics::element_at_share(ranges, 0.5);
  return summary;
}

}  // namespace

void LidarTrack::take(double t, const sensors::LidarScan& scan) {
  if (last_t_ && intervals_.size() < kFirstScans) intervals_.push_back(t - *last_t_);
  last_t_ = t;
  const bool is_taken = seen_ < kFirstScans || seen_ % kEvery == 0;
  ++seen_;
  if (is_taken && scans_.size() < kMaxScans) scans_.push_back(summary_of(t, scan));
}

std::optional<double> LidarTrack::interval_s() const {
  if (intervals_.empty()) return std::nullopt;
  return statistics::median(intervals_);
}

}  // namespace traverse::plausibility
