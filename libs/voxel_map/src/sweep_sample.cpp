#include "traverse/voxel_map/sweep_sample.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "traverse/lidar/stopwatch.hpp"
#include "traverse/parallel/workers.hpp"
#include "traverse/sensors/sweep_timing.hpp"
#include "traverse/sensors/vertical_correction.hpp"

#include "point_hash.hpp"

namespace traverse::voxel_map {

namespace {

constexpr std::size_t kRowsInChunk = 4;
constexpr std::size_t kExpected = 2048;  // surface points of a chunk
constexpr std::size_t kLeastRow = 20;    // points; a shorter row says little and is passed over

/// 0 ... count - 1 in the order of their reversed bits.
std::vector<std::size_t> bit_reversed_order(std::size_t count) {
  unsigned bits = 0;
  while ((std::size_t{1} << bits) < count) ++bits;
  std::vector<std::size_t> order;
  order.reserve(count);
  for (std::size_t k = 0; k < std::size_t{1} << bits; ++k) {
    std::size_t reversed = 0;
    for (unsigned b = 0; b < bits; ++b) reversed |= (k >> b & 1U) << (bits - 1 - b);
    if (reversed < count) order.push_back(reversed);
  }
  return order;
}

Seam seam_of(const sensors::PointClock& clock, const sensors::LidarProfile& profile) {
  Seam seam;
  if (!clock.knows()) return seam;
  if (profile.time_source == sensors::TimeSource::kAzimuth) {
    const double azimuth = profile.seam_azimuth_deg * std::numbers::pi / 180;
    seam.by_azimuth = true;
    seam.x = static_cast<float>(std::cos(azimuth));
    seam.y = static_cast<float>(std::sin(azimuth));
  } else {
    seam.time_jump_s = static_cast<float>(0.25 * profile.sweep_s);
  }
  return seam;
}

/// Times as sensors::PointClock gives them, by the fast azimuth where it would take atan2.
void set_times(const sensors::PointClock& clock, const sensors::LidarProfile& profile,
               SweepPoints& points) {
  if (!clock.knows()) return;
  const std::size_t n = points.size();
  if (profile.time_source != sensors::TimeSource::kAzimuth) {
    for (std::size_t i = 0; i < n; ++i) points.time[i] = clock(points.source[i]);
    return;
  }
  const auto seam = static_cast<float>(profile.seam_azimuth_deg / 360);
  const float sign = profile.rotation == sensors::Rotation::kClockwise ? -1.0F : 1.0F;
  const auto stamp = static_cast<float>(profile.stamp_fraction);
  const auto sweep = static_cast<float>(profile.sweep_s);
  constexpr auto kPerTurn = static_cast<float>(0.5 / std::numbers::pi);
  const float* x = points.x.data();
  const float* y = points.y.data();
  float* time = points.time.data();
  for (std::size_t i = 0; i < n; ++i) {
    const float turned = sign * (fast_azimuth(x[i], y[i]) * kPerTurn - seam);  // within (-2, 2)
    const float whole = static_cast<float>(static_cast<int>(turned + 4)) - 4;  // the floor
    time[i] = (turned - whole - stamp) * sweep;
  }
}

void correct(const sensors::LidarProfile& profile, SweepPoints& points) {
  if (profile.vertical_correction_deg == 0) return;
  sensors::correct_elevation(points.x.data(), points.y.data(), points.z.data(), points.size(),
                             profile.vertical_correction_deg * std::numbers::pi / 180);
}

/// Rows that one worker takes: of one lidar, in bit-reversed order.
std::vector<std::vector<std::size_t>> chunks_of(const SweepRows& rows) {
  std::vector<std::vector<std::size_t>> chunks;
  for (std::size_t begin = 0; begin < rows.count();) {
    const std::size_t lidar = rows.row(begin).lidar;
    std::size_t end = begin + 1;
    while (end < rows.count() && rows.row(end).lidar == lidar) ++end;
    const std::vector<std::size_t> order = bit_reversed_order(end - begin);
    for (std::size_t k = 0; k < order.size(); ++k) {
      if (k % kRowsInChunk == 0) chunks.emplace_back();
      chunks.back().push_back(begin + order[k]);
    }
    begin = end;
  }
  return chunks;
}

/// Moves the points from the given one on.
void move(const Row& row, std::size_t from, SweepPoints& points) {
  for (std::size_t i = from; i < points.size(); ++i) {
    points.x[i] += row.ox;
    points.y[i] += row.oy;
    points.z[i] += row.oz;
  }
}

struct ChunkSample {
  std::size_t lidar = 0;
  RowSamples samples;
  std::vector<std::uint32_t> first_of_cube;  // indices of samples.surface
};

}  // namespace

std::array<std::size_t, lidar::kFeatureClasses> SweepSample::class_counts() const {
  std::array<std::size_t, lidar::kFeatureClasses> counts{};
  const auto count = [&](lidar::FeatureClass c) -> std::size_t& {
    return counts[static_cast<std::size_t>(c)];
  };
  const auto planar_in_surface = static_cast<std::size_t>(
      std::count(surface_is_planar.begin(), surface_is_planar.end(), std::uint8_t{1}));
  count(lidar::FeatureClass::kSharp) = edges.size();
  count(lidar::FeatureClass::kFlat) = planar.size();
  count(lidar::FeatureClass::kLessFlat) = planar_in_surface - planar.size();
  count(lidar::FeatureClass::kNone) = surface.size() - planar_in_surface;
  return counts;
}

std::vector<std::uint32_t> first_of_each_cube(const SweepPoints& points,
                                              const std::vector<std::uint8_t>& mark,
                                              double cube_m) {
  const auto per_m = static_cast<float>(1 / cube_m);
  PointHash seen(points.size());
  std::vector<std::uint32_t> first;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (mark[i] == 0) continue;
    const std::uint32_t key =
        PointHash::key(points.x[i] * per_m, points.y[i] * per_m, points.z[i] * per_m);
    if (seen.insert(key)) first.push_back(static_cast<std::uint32_t>(i));
  }
  return first;
}

SweepSample sample_sweep(const sensors::LidarScan& scan, const sensors::LidarProfile& profile,
                         const SamplingOptions& options, parallel::Workers& workers) {
  lidar::Stopwatch watch;
  SweepSample sample;
  sample.stamp = scan.stamp;
  sample.points = scan.size();
  const SweepRows rows(scan, profile);
  sample.dropped = rows.dropped();
  sample.from_range_image = rows.from_range_image();
  watch.lap(sample.organise_ms);

  const sensors::PointClock clock(scan, profile);
  sample.timed = clock.knows();
  const Seam seam = seam_of(clock, profile);
  SamplingOptions limited = options;
  limited.max_range_m = std::min(options.max_range_m, profile.max_range_m);
  limited.edge_max_range_m = std::min(options.edge_max_range_m, profile.max_range_m);
  const auto nearest = static_cast<float>(profile.min_range_m);
  const auto pole_depth = static_cast<float>(profile.pole_depth);
  const std::vector<std::vector<std::size_t>> rows_of = chunks_of(rows);
  std::vector<ChunkSample> chunks(rows_of.size());
  workers.run(chunks.size(), [&](std::size_t c) {
    ChunkSample& chunk = chunks[c];
    chunk.samples.reserve(kExpected);
    std::vector<std::uint8_t> breaks;
    for (const std::size_t k : rows_of[c]) {
      const Row row = rows.row(k);
      chunk.lidar = row.lidar;
      if (row.size < kLeastRow) continue;
      const std::size_t surfaces = chunk.samples.surface.size();
      const std::size_t edges = chunk.samples.edges.size();
      find_breaks(row, limited, seam, breaks);
      sample_surfaces(row, breaks, limited, nearest, chunk.samples);
      sample_edges(row, breaks, limited, nearest, pole_depth, chunk.samples);
      if (profile.lidars_in_scan.size() < 2) continue;
      move(row, surfaces, chunk.samples.surface);
      move(row, edges, chunk.samples.edges);
    }
    for (SweepPoints* points : {&chunk.samples.surface, &chunk.samples.edges}) {
      correct(profile, *points);
      set_times(clock, profile, *points);
    }
    chunk.first_of_cube =
        first_of_each_cube(chunk.samples.surface, chunk.samples.planar, limited.thinning_m);
  });

  // A point that is not the first of its cube within its chunk is not the first of all. What one
  // lidar measures of a cube does not stand for what another does.
  SweepPoints candidates;
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    const ChunkSample& chunk = chunks[c];
    sample.surface.append(chunk.samples.surface);
    sample.edges.append(chunk.samples.edges);
    sample.surface_is_planar.insert(sample.surface_is_planar.end(), chunk.samples.planar.begin(),
                                    chunk.samples.planar.end());
    for (const std::uint32_t i : chunk.first_of_cube) candidates.append(chunk.samples.surface, i);
    if (c + 1 < chunks.size() && chunks[c + 1].lidar == chunk.lidar) continue;
    const std::vector<std::uint8_t> all(candidates.size(), 1);
    for (const std::uint32_t i : first_of_each_cube(candidates, all, limited.thinning_m)) {
      sample.planar.append(candidates, i);
    }
    candidates = {};
  }
  watch.lap(sample.features_ms);
  return sample;
}

std::pair<double, double> time_span(const SweepSample& sample) {
  std::pair<double, double> span{0, 0};
  bool is_first = true;
  for (const SweepPoints* points : {&sample.surface, &sample.edges}) {
    if (points->size() == 0) continue;
    const auto [low, high] = std::minmax_element(points->time.begin(), points->time.end());
    span.first = is_first ? *low : std::min<double>(span.first, *low);
    span.second = is_first ? *high : std::max<double>(span.second, *high);
    is_first = false;
  }
  return span;
}

void count_times_from(double middle_s, SweepSample& sample) {
  const auto shift = static_cast<float>(middle_s - sample.middle_s);
  for (SweepPoints* points : {&sample.surface, &sample.planar, &sample.edges}) {
    for (float& time : points->time) time -= shift;
  }
  sample.middle_s = middle_s;
}

}  // namespace traverse::voxel_map
