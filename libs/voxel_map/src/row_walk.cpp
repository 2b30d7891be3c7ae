#include "traverse/voxel_map/row_walk.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "traverse/statistics/quantile.hpp"

#include "lanes.hpp"

namespace traverse::voxel_map {

namespace {

constexpr std::size_t kReach = 5;  // neighbours on each side of a surface point, at most
/// Radians that they span on each side: a ring on a floor is an arc, whose middle leaves its ends
/// by 0.6 per mille of the range in this window.
constexpr float kWindow = 0.035F;
/// Neighbours on a surface are this times as far apart as one that is seen head-on: at 70 degrees.
constexpr float kGrazing = 3;
constexpr float kDenseGap =
    1.1F * kWindow / kReach;         // radians between beams of a dense scan: 0.44 deg
constexpr float kWidestGap = 0.09F;  // radians between neighbours; beyond it they are no neighbours
constexpr float kOfUniform = 1.0F / 12;  // variance of what lies anywhere in a step of 1
constexpr float kLead = 1;               // steps, of two points, that a receding surface is led on

float to_float(double value) { return static_cast<float>(value); }

/// work(first, last) for each surface of the row, both points included.
template <typename Work>
void for_each_surface(const Row& row, const std::vector<std::uint8_t>& breaks, const Work& work) {
  std::size_t first = 0;
  for (std::size_t i = 0; i + 1 < row.size;) {
    std::uint64_t eight = 0;
    if (i + 9 < row.size) {
      std::memcpy(&eight, &breaks[i], 8);
      if (eight == 0) {
        i += 8;
        continue;
      }
    }
    if (breaks[i] != kNoBreak) {
      work(first, i);
      first = i + 1;
    }
    ++i;
  }
  if (first < row.size) work(first, row.size - 1);
}

/// Radians between the directions of points i and i + 1, small angles.
float gap_between(const Row& row, std::size_t i) {
  const float scale = 1 / (row.range[i] * row.range[i + 1] + 1e-12F);
  const float cx = row.y[i] * row.z[i + 1] - row.z[i] * row.y[i + 1];
  const float cy = row.z[i] * row.x[i + 1] - row.x[i] * row.z[i + 1];
  const float cz = row.x[i] * row.y[i + 1] - row.y[i] * row.x[i + 1];
  return scale * std::sqrt(cx * cx + cy * cy + cz * cz);
}

/// Points of the row that go on `spacing` metres from point i, at least one.
std::size_t points_in(float spacing, const Row& row, std::size_t reach, std::size_t i) {
  const float ex = row.x[i + reach] - row.x[i - reach];
  const float ey = row.y[i + reach] - row.y[i - reach];
  const float ez = row.z[i + reach] - row.z[i - reach];
  const float share = 1.0F / static_cast<float>(2 * reach);
  const float step = std::sqrt(ex * ex + ey * ey + ez * ez) * share + 1e-4F;
  const float points = spacing / step;
  const auto whole = static_cast<std::int32_t>(points);
  const std::int32_t ceiling =
      whole + static_cast<std::int32_t>(static_cast<float>(whole) < points);
  return static_cast<std::size_t>(std::max(1, ceiling));
}

/// Of the 2 reach + 1 values around `middle`; eleven by short sums, which do not wait for each
/// other.
float window_mean(const float* middle, std::size_t reach) {
  if (reach != kReach) {
    float sum = 0;
    for (const float* v = middle - reach; v <= middle + reach; ++v) sum += *v;
    return sum / static_cast<float>(2 * reach + 1);
  }
  const float* v = middle - kReach;
  const float sum =
      ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7])) + ((v[8] + v[9]) + v[10]);
  return sum * (1.0F / (2 * kReach + 1));
}

/// The width that a pole usually has that `count` beams of a row hit, in steps between beams; two
/// beams at least. A pole q steps wide is hit by n beams with the probability 1 - |q - n|, wherever
/// it stands between them. Poles come in all widths at all distances, so that no q is likelier than
/// another on a scale of ratios: the mean of q over dq / q is 1 / ((n + 1) ln((n + 1) / n) -
/// (n - 1) ln(n / (n - 1))), which is n - 1 / (6 n) to 0.006. n whole steps would be the width
/// of poles that mostly are narrower, and were found since one more beam just hit them.
float usual_width(std::size_t count) {
  const auto n = static_cast<float>(count);
  return n - 1 / (6 * n);
}

/// Adds the chosen points to the surface: a planar one at the mean of its window.
void place(const Row& row, std::size_t reach, const SamplingOptions& options, RowSamples& samples) {
  const float flatness = to_float(options.flatness_m);
  const float flatness_per_m = to_float(options.flatness_per_m);
  SweepPoints& surface = samples.surface;
  std::size_t to = surface.size();
  surface.resize(to + samples.chosen.size());
  samples.planar.resize(surface.size());
  for (const std::uint32_t i : samples.chosen) {
    const float mx = window_mean(row.x + i, reach);
    const float my = window_mean(row.y + i, reach);
    const float mz = window_mean(row.z + i, reach);
    const float dx = mx - row.x[i];
    const float dy = my - row.y[i];
    const float dz = mz - row.z[i];
    const float limit = flatness + flatness_per_m * row.range[i];
    const bool planar = dx * dx + dy * dy + dz * dz < limit * limit;
    surface.x[to] = planar ? mx : row.x[i];
    surface.y[to] = planar ? my : row.y[i];
    surface.z[to] = planar ? mz : row.z[i];
    surface.range[to] = row.range[i];
    surface.source[to] = row.source_of(i);
    samples.planar[to] = static_cast<std::uint8_t>(planar);
    ++to;
  }
}

/// Where neighbours are farther apart than base + per_m * range.
TRAVERSE_AVX2_TOO
void mark_steps(const float* __restrict x, const float* __restrict y, const float* __restrict z,
                const float* __restrict range, std::size_t count, float base, float per_m,
                std::uint8_t* __restrict breaks) {
  for (std::size_t i = 0; i < count; ++i) {
    const float dx = x[i + 1] - x[i];
    const float dy = y[i + 1] - y[i];
    const float dz = z[i + 1] - z[i];
    const float limit = base + per_m * range[i];
    breaks[i] = dx * dx + dy * dy + dz * dz > limit * limit ? kStep : kNoBreak;
  }
}

/// The angle between neighbours that half of the row's do not exceed, from a part of them.
float usual_gap(const Row& row) {
  constexpr std::size_t kLooked = 64;
  std::vector<float> gaps;
  const std::size_t step = std::max<std::size_t>(1, (row.size - 1) / kLooked);
  for (std::size_t i = 0; i + 1 < row.size; i += step) gaps.push_back(gap_between(row, i));
  return statistics::element_at_share(gaps, 0.5);
}

/// Neighbours on each side that a surface point is judged by.
std::size_t reach_of(const Row& row) {
  if (row.size < 2) return kReach;
  const float gap = std::max(usual_gap(row), 1e-6F);
  return static_cast<std::size_t>(
      std::clamp(kWindow / gap + 0.5F, 1.0F, static_cast<float>(kReach)));
}

/// Takes back breaks between beams that are far apart, or between which some did not return: there
/// a step says little of the surface.
void join_across_gaps(const Row& row, float base, std::vector<std::uint8_t>& breaks) {
  for (std::size_t i = 0; i + 1 < row.size; ++i) {
    if (breaks[i] == kNoBreak) continue;
    const float gap = gap_between(row, i);
    if (gap <= kDenseGap || gap > kWidestGap) continue;
    const float dx = row.x[i + 1] - row.x[i];
    const float dy = row.y[i + 1] - row.y[i];
    const float dz = row.z[i + 1] - row.z[i];
    const float limit = base + kGrazing * gap * std::min(row.range[i], row.range[i + 1]);
    if (dx * dx + dy * dy + dz * dz <= limit * limit) breaks[i] = kNoBreak;
  }
}

/// Where neighbours lie on either side of the half line along (sx, sy).
TRAVERSE_AVX2_TOO
void mark_seam(const float* __restrict x, const float* __restrict y, std::size_t count, float sx,
               float sy, std::uint8_t* __restrict breaks) {
  for (std::size_t i = 0; i < count; ++i) {
    const float side = sx * y[i] - sy * x[i];
    const float next_side = sx * y[i + 1] - sy * x[i + 1];
    const float along = sx * x[i] + sy * y[i];
    const int crossed = static_cast<int>(side * next_side <= 0) & static_cast<int>(along > 0);
    breaks[i] = static_cast<std::uint8_t>(breaks[i] | (crossed * kSeam));
  }
}

}  // namespace

void bind(config::Binder& b, SamplingOptions& o) {
  using config::Range;
  b.number("max_range_m", o.max_range_m, Range::between(1, 150),
           "farther points are not planar points");
  b.number("break_m", o.break_m, Range::positive(), "neighbours farther apart are on two surfaces");
  b.number("break_per_m", o.break_per_m, Range::non_negative(),
           "added to break_m per metre of range");
  b.number("spacing_m", o.spacing_m, Range::non_negative(), "between surface points along a ring");
  b.number("flatness_m", o.flatness_m, Range::positive(),
           "largest distance of a planar point from the mean of its neighbours");
  b.number("flatness_per_m", o.flatness_per_m, Range::non_negative(),
           "added to flatness_m per metre of range");
  b.number("thinning_m", o.thinning_m, Range::between(0.05, 5),
           "voxel size: one planar point per voxel is registered");
  b.number("boundary_m", o.boundary_m, Range::positive(), "range step at an edge point");
  b.number("edge_max_range_m", o.edge_max_range_m, Range::between(1, 150),
           "largest range of edge points");
  b.number("pole_width_m", o.pole_width_m, Range::non_negative(),
           "largest width of a pole with background on both sides");
}

void RowSamples::reserve(std::size_t points) {
  surface.reserve(points);
  planar.reserve(points);
}

void find_breaks(const Row& row, const SamplingOptions& options, const Seam& seam,
                 std::vector<std::uint8_t>& breaks) {
  breaks.resize(row.size);
  if (row.size < 2) return;
  const std::size_t n = row.size - 1;
  mark_steps(row.x, row.y, row.z, row.range, n, to_float(options.break_m),
             to_float(options.break_per_m), breaks.data());
  join_across_gaps(row, to_float(options.break_m), breaks);
  if (seam.by_azimuth) {
    mark_seam(row.x, row.y, n, seam.x, seam.y, breaks.data());
  } else if (row.time != nullptr) {
    for (std::size_t i = 0; i < n; ++i) {
      const int jump = static_cast<int>(std::abs(row.time[i + 1] - row.time[i]) > seam.time_jump_s);
      breaks[i] = static_cast<std::uint8_t>(breaks[i] | (jump * kSeam));
    }
  }
}

void sample_surfaces(const Row& row, const std::vector<std::uint8_t>& breaks,
                     const SamplingOptions& options, float nearest, RowSamples& samples) {
  const float most = to_float(options.max_range_m);
  const float spacing = to_float(options.spacing_m);
  const std::size_t reach = reach_of(row);
  samples.chosen.clear();
  for_each_surface(row, breaks, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first + reach; i + reach <= last;) {
      if (row.range[i] >= most || row.range[i] < nearest) {
        ++i;
        continue;
      }
      samples.chosen.push_back(static_cast<std::uint32_t>(i));
      i += points_in(spacing, row, reach, i);
    }
  });
  place(row, reach, options, samples);
}

void sample_edges(const Row& row, const std::vector<std::uint8_t>& breaks,
                  const SamplingOptions& options, float nearest, float pole_depth,
                  RowSamples& samples) {
  const float jump = to_float(options.boundary_m);
  const float most = to_float(options.edge_max_range_m);
  const float width = to_float(options.pole_width_m);
  const float* x = row.x;
  const float* y = row.y;
  const float* z = row.z;
  const float* range = row.range;
  // The surface ends somewhere between its last point and the next beam: half a step on, on the
  // average. Without it an edge would creep outward as the sensor comes nearer and steps shrink.
  const auto push_end = [&](std::size_t end, std::size_t inner) {
    constexpr float kHalfStep = 0.25F;  // of two steps
    const float dx = x[end] - x[inner];
    const float dy = y[end] - y[inner];
    const float dz = z[end] - z[inner];
    samples.edges.push_back(x[end] + kHalfStep * dx, y[end] + kHalfStep * dy,
                            z[end] + kHalfStep * dz, range[end], row.source_of(end));
    samples.edges.step_variance.push_back(kOfUniform * 0.25F * (dx * dx + dy * dy + dz * dz));
  };
  for_each_surface(row, breaks, [&](std::size_t first, std::size_t last) {
    if (first == 0 || last + 1 == row.size) return;
    if (range[first] >= most || range[first] < nearest) return;
    const bool left_open = (breaks[first - 1] & kSeam) == 0;
    const bool right_open = (breaks[last] & kSeam) == 0;
    const bool left = left_open && range[first - 1] > range[first] + jump;
    const bool right = right_open && range[last + 1] > range[last] + jump;
    const std::size_t count = last - first + 1;
    const float dx = x[last] - x[first];
    const float dy = y[last] - y[first];
    const float dz = z[last] - z[first];
    if (left && right && dx * dx + dy * dy + dz * dz < width * width) {
      if (count < 2) return;
      float mx = 0;
      float my = 0;
      float mz = 0;
      for (std::size_t k = first; k <= last; ++k) {
        mx += x[k];
        my += y[k];
        mz += z[k];
      }
      const float share = 1 / static_cast<float>(count);
      mx *= share;
      my *= share;
      // Across the line of sight: between the returns themselves their ranges' noise would add to
      // it.
      const float flat = std::sqrt(mx * mx + my * my);
      const float step = std::abs(dx * my - dy * mx) / flat / static_cast<float>(count - 1);
      const float radius = 0.5F * usual_width(count) * step;
      const float outward = 1 + pole_depth * radius / flat;
      samples.edges.push_back(outward * mx, outward * my, mz * share, range[first],
                              row.source_of((first + last) / 2));
      samples.edges.step_variance.push_back(kOfUniform * step * step);
      return;
    }
    if (count < 3) return;
    // A wall seen at a grazing angle recedes in steps that are breaks of their own: its last point
    // before them is no end, and would travel with the sensor.
    const auto led_to = [&](std::size_t end, std::size_t inner) {
      return range[end] + std::max(0.0F, kLead * (range[end] - range[inner]));
    };
    if (left && range[first - 1] > led_to(first, first + 2) + jump) push_end(first, first + 2);
    if (right && range[last + 1] > led_to(last, last - 2) + jump) push_end(last, last - 2);
  });
}

}  // namespace traverse::voxel_map
