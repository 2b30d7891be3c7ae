#include "traverse/voxel_map/sweep_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "traverse/sensors/rings.hpp"

#include "lanes.hpp"

namespace traverse::voxel_map {

namespace {

constexpr std::uint16_t kLeftOut = 0xffff;

/// Counts of points by what their range says; a NaN is in none of them.
struct RangeCounts {
  std::size_t origin = 0, near = 0, far = 0, usable = 0;
};

TRAVERSE_AVX2_TOO
RangeCounts measure_ranges(const sensors::LidarScan& scan, const sensors::LidarProfile& profile,
                           std::vector<float>& range) {
  const std::size_t n = scan.size();
  range.resize(n);
  const float* x = scan.x.data();
  const float* y = scan.y.data();
  const float* z = scan.z.data();
  float* r = range.data();
  const auto least = static_cast<float>(profile.min_range_m);
  const auto most = static_cast<float>(profile.max_range_m);
  constexpr float kLargest = std::numeric_limits<float>::max();
  std::int32_t origin = 0;
  std::int32_t near = 0;
  std::int32_t far = 0;
  std::int32_t usable = 0;
  for (std::size_t i = 0; i < n; ++i) {
    r[i] = std::sqrt(x[i] * x[i] + y[i] * y[i] + z[i] * z[i]);
    origin += static_cast<std::int32_t>(r[i] == 0);
    near += static_cast<std::int32_t>((r[i] > 0) & (r[i] < least));
    far += static_cast<std::int32_t>((r[i] > most) & (r[i] <= kLargest));
    usable += static_cast<std::int32_t>((r[i] > 0) & (r[i] >= least) & (r[i] <= most));
  }
  return {static_cast<std::size_t>(origin), static_cast<std::size_t>(near),
          static_cast<std::size_t>(far), static_cast<std::size_t>(usable)};
}

/// Where rings begin in a scan stored ring after ring, counterclockwise from straight ahead; the
/// same rule as sensors::assign_rings for a scan without missing returns.
std::vector<std::uint32_t> ring_begins(const sensors::LidarScan& scan) {
  std::vector<std::uint32_t> begins{0};
  const float* x = scan.x.data();
  const float* y = scan.y.data();
  const auto wraps = [&](std::size_t i) {
    return static_cast<int>(y[i - 1] < 0) & static_cast<int>(y[i] >= 0) &
           static_cast<int>(x[i] > 0);
  };
  constexpr std::size_t kBlock = 128;  // nearly always without a wrap: one look for all of it
  for (std::size_t i = 1; i < scan.size(); i += kBlock) {
    const std::size_t end = std::min(scan.size(), i + kBlock);
    int any = 0;
    for (std::size_t k = i; k < end; ++k) any |= wraps(k);
    if (any == 0) continue;
    for (std::size_t k = i; k < end; ++k) {
      if (wraps(k) != 0) begins.push_back(static_cast<std::uint32_t>(k));
    }
  }
  begins.push_back(static_cast<std::uint32_t>(scan.size()));
  return begins;
}

bool rings_can_be_assigned(const sensors::LidarScan& scan, const sensors::LidarProfile& profile) {
  if (profile.ring_source == sensors::RingSource::kData) return !scan.ring.empty();
  if (profile.ring_source == sensors::RingSource::kElevation) {
    return !profile.elevations_deg.empty();
  }
  return true;
}

float elevation_of(const sensors::LidarScan& scan, std::size_t i) {
  return std::atan2(scan.z[i], std::hypot(scan.x[i], scan.y[i]));
}

}  // namespace

SweepRows::SweepRows(const sensors::LidarScan& scan, const sensors::LidarProfile& profile)
    : scan_(scan), lidars_(profile.lidars_in_scan) {
  if (scan.empty()) return;
  const RangeCounts counts = measure_ranges(scan, profile, range_);
  dropped_.at_origin = counts.origin;
  dropped_.out_of_range = counts.near + counts.far;
  dropped_.not_finite = scan.size() - counts.origin - counts.near - counts.far - counts.usable;

  const std::size_t max_rings =
      profile.rings > 0 ? static_cast<std::size_t>(profile.rings) : std::size_t{kLeftOut};
  const bool missing_returns = dropped_.at_origin + dropped_.not_finite > 0;
  if (profile.ring_source == sensors::RingSource::kStorageOrder && !missing_returns) {
    borrowed_ = true;
    row_begin_ = ring_begins(scan);
    if (count() > max_rings) {
      dropped_.beyond_profile_rings = scan.size() - row_begin_[max_rings];
      row_begin_.resize(max_rings + 1);
    }
    return;
  }

  std::vector<std::uint16_t> ring;
  if (rings_can_be_assigned(scan, profile)) {
    ring = sensors::assign_rings(scan, profile).ring;
  } else {
    from_range_image_ = true;
    ring = range_image_rows(profile);
  }
  std::size_t rings = 0;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const bool returned = range_[i] > 0 && range_[i] <= std::numeric_limits<float>::max();
    if (returned && ring[i] >= max_rings) ++dropped_.beyond_profile_rings;
    if (!returned || ring[i] >= max_rings) ring[i] = kLeftOut;
    if (ring[i] != kLeftOut) rings = std::max<std::size_t>(rings, ring[i] + 1U);
  }
  sort_rows(ring, rings);
  if (from_range_image_) sort_by_azimuth();
  for (std::size_t i = 0; i < source_.size(); ++i) {
    x_.push_back(scan.x[source_[i]]);
    y_.push_back(scan.y[source_[i]]);
    z_.push_back(scan.z[source_[i]]);
  }
  std::vector<float> sorted_range(source_.size());
  for (std::size_t i = 0; i < source_.size(); ++i) sorted_range[i] = range_[source_[i]];
  range_ = std::move(sorted_range);
  if (lidars_.size() > 1) look_from_own_lidars();
  if (!scan.time.empty()) {
    for (const std::uint32_t i : source_) time_.push_back(scan.time[i]);
  }
}

Row SweepRows::row(std::size_t k) const {
  const std::size_t begin = row_begin_[k];
  const std::size_t size = row_begin_[k + 1] - begin;
  const auto at = [&](const std::vector<float>& values) {
    return values.empty() ? nullptr : values.data() + begin;
  };
  if (borrowed_) {
    return {at(scan_.x),    at(scan_.y), at(scan_.z), at(range_),
            at(scan_.time), nullptr,     begin,       size};
  }
  Row row{at(x_), at(y_), at(z_), at(range_), at(time_), source_.data() + begin, begin, size};
  if (lidars_.size() > 1) {
    row.lidar = lidar_of(k);
    const auto& origin = lidars_[row.lidar].origin_m;
    row.ox = static_cast<float>(origin[0]);
    row.oy = static_cast<float>(origin[1]);
    row.oz = static_cast<float>(origin[2]);
  }
  return row;
}

std::size_t SweepRows::lidar_of(std::size_t ring) const {
  std::size_t lidar = 0;
  while (lidar + 1 < lidars_.size() && lidars_[lidar + 1].first_ring <= ring) ++lidar;
  return lidar;
}

void SweepRows::look_from_own_lidars() {
  for (std::size_t k = 0; k < count(); ++k) {
    const Row here = row(k);
    for (std::size_t i = row_begin_[k]; i < row_begin_[k + 1]; ++i) {
      x_[i] -= here.ox;
      y_[i] -= here.oy;
      z_[i] -= here.oz;
      range_[i] = std::sqrt(x_[i] * x_[i] + y_[i] * y_[i] + z_[i] * z_[i]);
    }
  }
}

std::vector<std::uint16_t> SweepRows::range_image_rows(const sensors::LidarProfile& profile) const {
  const std::size_t rows =
      profile.rings > 0 ? static_cast<std::size_t>(profile.rings) : kRangeImageRows;
  std::vector<float> elevations;
  for (std::size_t i = 0; i < scan_.size(); ++i) {
    if (range_[i] > 0 && range_[i] <= std::numeric_limits<float>::max()) {
      elevations.push_back(elevation_of(scan_, i));
    }
  }
  std::vector<std::uint16_t> row(scan_.size(), 0);
  if (elevations.empty()) return row;
  // The lowest and highest two hundredths do not stretch the bands.
  const std::size_t tail = elevations.size() / 200;
  std::sort(elevations.begin(), elevations.end());
  const float lowest = elevations[tail];
  const float highest = elevations[elevations.size() - 1 - tail];
  const float band = std::max((highest - lowest) / static_cast<float>(rows), 1e-4F);
  for (std::size_t i = 0; i < scan_.size(); ++i) {
    if (!(range_[i] > 0 && range_[i] <= std::numeric_limits<float>::max())) continue;
    const float k = std::floor((elevation_of(scan_, i) - lowest) / band);
    row[i] = static_cast<std::uint16_t>(std::clamp(k, 0.0F, static_cast<float>(rows - 1)));
  }
  return row;
}

void SweepRows::sort_rows(const std::vector<std::uint16_t>& ring, std::size_t rings) {
  // Counting sort: stable, so each row keeps the storage order.
  row_begin_.assign(rings + 1, 0);
  for (const std::uint16_t k : ring) {
    if (k != kLeftOut) ++row_begin_[k + 1U];
  }
  std::partial_sum(row_begin_.begin(), row_begin_.end(), row_begin_.begin());
  source_.resize(row_begin_.back());
  std::vector<std::uint32_t> next = row_begin_;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (ring[i] != kLeftOut) source_[next[ring[i]]++] = static_cast<std::uint32_t>(i);
  }
}

void SweepRows::sort_by_azimuth() {
  std::vector<float> azimuth(scan_.size());
  for (const std::uint32_t i : source_) azimuth[i] = std::atan2(scan_.y[i], scan_.x[i]);
  for (std::size_t k = 0; k < count(); ++k) {
    std::stable_sort(source_.begin() + row_begin_[k], source_.begin() + row_begin_[k + 1],
                     [&](std::uint32_t a, std::uint32_t b) { return azimuth[a] < azimuth[b]; });
  }
}

}  // namespace traverse::voxel_map
