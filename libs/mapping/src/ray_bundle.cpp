#include "ray_bundle.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "traverse/geometry/angle.hpp"

namespace traverse::mapping {

namespace {

double azimuth_of(const Eigen::Vector3d& d) { return std::atan2(d.y(), d.x()); }
double elevation_of(const Eigen::Vector3d& d) {
  return std::atan2(d.z(), std::hypot(d.x(), d.y()));
}

}  // namespace

int RayBundle::row_of(double elevation_rad) {
  return std::clamp(static_cast<int>(elevation_rad / geometry::kDegree + kRows / 2.0), 0,
                    kRows - 1);
}

int RayBundle::column_of(double azimuth_rad) {
  const int column = static_cast<int>(std::floor(azimuth_rad / geometry::kDegree));
  return ((column % kColumns) + kColumns) % kColumns;
}

RayBundle::RayBundle(const MapKeyframe& keyframe)
    : origin_(keyframe.T_map_body * keyframe.p_body_sensor) {
  std::vector<std::size_t> bins(keyframe.size());
  std::vector<Ray> rays(keyframe.size());
  begin_.assign(static_cast<std::size_t>(kRows * kColumns) + 1, 0);
  for (std::size_t i = 0; i < keyframe.size(); ++i) {
    const Eigen::Vector3d d = keyframe.T_map_body * keyframe.p_body(i) - origin_;
    const double length = d.norm();
    rays[i] = {(d / std::max(length, 1e-9)).cast<float>(), static_cast<float>(length)};
    bins[i] =
        static_cast<std::size_t>(row_of(elevation_of(d)) * kColumns + column_of(azimuth_of(d)));
    ++begin_[bins[i] + 1];
  }
  for (std::size_t bin = 1; bin < begin_.size(); ++bin) begin_[bin] += begin_[bin - 1];
  rays_.resize(rays.size());
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t i = 0; i < rays.size(); ++i) rays_[next[bins[i]]++] = rays[i];
}

std::optional<RayBundle::Pass> RayBundle::nearest(const Eigen::Vector3d& p_map,
                                                  double radius_m) const {
  constexpr int kMostBins = 3;  // to either side; rays are denser than that near the sensor
  const Eigen::Vector3d d = p_map - origin_;
  const double range = d.norm();
  if (range < radius_m) return std::nullopt;
  const int reach = std::min(kMostBins, 1 + static_cast<int>(radius_m / range / geometry::kDegree));
  const int row = row_of(elevation_of(d));
  const int column = column_of(azimuth_of(d));
  std::optional<Pass> best;
  double best_distance = radius_m;
  for (int r = std::max(0, row - reach); r <= std::min(kRows - 1, row + reach); ++r) {
    for (int dc = -reach; dc <= reach; ++dc) {
      const auto bin = static_cast<std::size_t>(r * kColumns + (column + dc + kColumns) % kColumns);
      for (std::size_t k = begin_[bin]; k < begin_[bin + 1]; ++k) {
        const Eigen::Vector3d u = rays_[k].direction.cast<double>();
        const double along = u.dot(d);
        const double distance = (d - along * u).norm();
        if (along <= 0 || distance >= best_distance) continue;
        best_distance = distance;
        best = Pass{distance, static_cast<double>(rays_[k].length) - along, u};
      }
    }
  }
  return best;
}

}  // namespace traverse::mapping
