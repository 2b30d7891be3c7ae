#include "traverse/voxel_map/scan_matches.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "traverse/parallel/workers.hpp"

namespace traverse::voxel_map {

namespace {

constexpr std::size_t kAhead = 12;   // points, of fetching
constexpr std::size_t kChunk = 512;  // points
constexpr float kHorizontal = 0.8F;  // |normal_z| above: ground or ceiling

void move_row(PlaneRows& rows, std::size_t from, std::size_t to) {
  for (auto* values : {&rows.x, &rows.y, &rows.z, &rows.time, &rows.nx, &rows.ny, &rows.nz, &rows.d,
                       &rows.weight, &rows.age}) {
    (*values)[to] = (*values)[from];
  }
}

/// Closes the gaps between chunks of which only the first counts[c] rows are filled.
void compact(PlaneRows& rows, const std::vector<std::size_t>& counts) {
  std::size_t kept = 0;
  for (std::size_t c = 0; c < counts.size(); ++c) {
    const std::size_t begin = c * kChunk;
    if (begin == kept) {
      kept += counts[c];
      continue;
    }
    for (std::size_t k = 0; k < counts[c]; ++k) move_row(rows, begin + k, kept++);
  }
  rows.resize(kept);
}

void set_point(PlaneRows& rows, std::size_t row, const SweepPoints& points, std::size_t i) {
  rows.x[row] = points.x[i];
  rows.y[row] = points.y[i];
  rows.z[row] = points.z[i];
  rows.time[row] = points.time[i];
}

/// The answer for the point's cell, asked for only when the cell is another than last time.
template <typename Map, typename Answer>
const Answer* ask(const Map& map, const CellGrid& grid, const RelativeCell& cell,
                  ScanMatches::Remembered<Answer>& remembered) {
  if (!remembered.asked || !(remembered.cell == cell)) {
    remembered.cell = cell;
    remembered.asked = true;
    remembered.found = map.find(grid, cell, remembered.answer);
  }
  return remembered.found ? &remembered.answer : nullptr;
}

/// 1.4826 times the median of |residual| over its standard deviation, to 1/32 of one.
double robust_scale(const std::vector<float>& normalised) {
  constexpr float kBins = 32;  // in one standard deviation
  std::array<std::size_t, 257> histogram{};
  for (const float e : normalised) {
    ++histogram[static_cast<std::size_t>(std::min(e * kBins, 256.0F))];
  }
  const std::size_t half = (normalised.size() + 1) / 2;
  std::size_t below = 0;
  std::size_t bin = 0;
  while (bin < 256 && below + histogram[bin] < half) below += histogram[bin++];
  const double within =
      histogram[bin] == 0 ? 0
                          : static_cast<double>(half - below) / static_cast<double>(histogram[bin]);
  return 1.4826 * (static_cast<double>(bin) + within) / kBins;
}

}  // namespace

void bind(config::Binder& b, MatchOptions& o) {
  using config::Range;
  b.number("noise_m", o.noise_m, Range::positive(), "standard deviation of a residual, near");
  b.number("noise_per_m", o.noise_per_m, Range::non_negative(), "added per metre of range");
  b.number("line_noise_m", o.line_noise_m, Range::non_negative(), "added for lines");
}

void PlaneRows::resize(std::size_t rows) {
  for (auto* values : {&x, &y, &z, &time, &nx, &ny, &nz, &d, &weight, &age}) values->resize(rows);
}

std::size_t PlaneRows::bytes() const { return 10 * size() * sizeof(float); }

std::size_t ScanMatches::bytes() const {
  return planes.bytes() + line_1.bytes() + line_2.bytes() +
         plane_answers.size() * sizeof(Remembered<PlaneMap::Answer>) +
         line_answers.size() * sizeof(Remembered<LineMap::Answer>);
}

void ScanMatches::forget() {
  plane_answers.clear();
  line_answers.clear();
}

void associate(const SweepSample& sample, const LocalPoints& planar, const LocalPoints& edges,
               const VoxelMap& map, double gate_m, const MatchOptions& options,
               parallel::Workers& workers, ScanMatches& matches) {
  matches.origin_map = planar.origin_map;
  const auto gate = static_cast<float>(gate_m);
  const auto noise = static_cast<float>(options.noise_m * options.noise_m);
  const auto per_m = static_cast<float>(options.noise_per_m * options.noise_per_m);
  const auto line_noise = noise + static_cast<float>(options.line_noise_m * options.line_noise_m);

  const std::size_t plane_chunks = (planar.size() + kChunk - 1) / kChunk;
  const std::size_t line_chunks = (edges.size() + kChunk - 1) / kChunk;
  std::vector<std::size_t> plane_counts(plane_chunks, 0);
  std::vector<std::size_t> line_counts(line_chunks, 0);
  std::vector<std::size_t> standing(plane_chunks, 0);
  PlaneRows& planes = matches.planes;
  planes.resize(planar.size());
  matches.line_1.resize(edges.size());
  matches.line_2.resize(edges.size());
  matches.plane_answers.resize(planar.size());
  matches.line_answers.resize(edges.size());
  std::vector<float> normalised(planar.size());

  const auto match_planes = [&](std::size_t c) {
    const CellGrid grid = map.planes().grid(planar.origin_map);
    const std::size_t end = std::min(planar.size(), (c + 1) * kChunk);
    std::size_t row = c * kChunk;
    for (std::size_t i = c * kChunk; i < end; ++i) {
      const auto cell_of = [&](std::size_t k) {
        return grid.cell(planar.x[k], planar.y[k], planar.z[k]);
      };
      const auto is_new = [&](std::size_t k) { return k < end && !matches.plane_answers[k].asked; };
      if (is_new(i + 2 * kAhead)) map.planes().prefetch(grid, cell_of(i + 2 * kAhead));
      if (is_new(i + kAhead)) map.planes().prefetch_plane(grid, cell_of(i + kAhead));
      const PlaneMap::Answer* found = ask(map.planes(), grid, cell_of(i), matches.plane_answers[i]);
      if (found == nullptr) continue;
      const PlaneMap::Answer& plane = *found;
      const float r =
          plane.nx * planar.x[i] + plane.ny * planar.y[i] + plane.nz * planar.z[i] + plane.d;
      if (!(std::abs(r) <= gate)) continue;
      set_point(planes, row, sample.planar, i);
      planes.nx[row] = plane.nx;
      planes.ny[row] = plane.ny;
      planes.nz[row] = plane.nz;
      planes.d[row] = plane.d;
      planes.age[row] = plane.age;
      const float range = sample.planar.range[i];
      planes.weight[row] = 1 / (noise + per_m * range * range + plane.variance);
      normalised[row] = std::abs(r) * std::sqrt(planes.weight[row]);
      if (std::abs(plane.nz) <= kHorizontal) ++standing[c];
      ++row;
    }
    plane_counts[c] = row - c * kChunk;
  };
  const auto match_lines = [&](std::size_t c) {
    const CellGrid grid = map.lines().grid(edges.origin_map);
    const std::size_t end = std::min(edges.size(), (c + 1) * kChunk);
    std::size_t row = c * kChunk;
    for (std::size_t i = c * kChunk; i < end; ++i) {
      if (i + kAhead < end && !matches.line_answers[i + kAhead].asked) {
        const std::size_t k = i + kAhead;
        map.lines().prefetch(grid, grid.cell(edges.x[k], edges.y[k], edges.z[k]));
      }
      const LineMap::Answer* found =
          ask(map.lines(), grid, grid.cell(edges.x[i], edges.y[i], edges.z[i]),
              matches.line_answers[i]);
      if (found == nullptr) continue;
      const LineMap::Answer& line = *found;
      const auto distance = [&](const float* n, float d) {
        return n[0] * edges.x[i] + n[1] * edges.y[i] + n[2] * edges.z[i] + d;
      };
      const float r1 = distance(line.n1, line.d1);
      const float r2 = distance(line.n2, line.d2);
      if (!(r1 * r1 + r2 * r2 <= gate * gate)) continue;
      const float range = sample.edges.range[i];
      const float step = sample.edges.step_variance.empty() ? 0 : sample.edges.step_variance[i];
      const float weight = 1 / (line_noise + per_m * range * range + step + line.variance);
      const auto set = [&](PlaneRows& rows, const float* n, float d) {
        set_point(rows, row, sample.edges, i);
        rows.nx[row] = n[0];
        rows.ny[row] = n[1];
        rows.nz[row] = n[2];
        rows.d[row] = d;
        rows.weight[row] = weight;
        rows.age[row] = line.age;
      };
      set(matches.line_1, line.n1, line.d1);
      set(matches.line_2, line.n2, line.d2);
      ++row;
    }
    line_counts[c] = row - c * kChunk;
  };
  workers.run(plane_chunks + line_chunks, [&](std::size_t c) {
    c < plane_chunks ? match_planes(c) : match_lines(c - plane_chunks);
  });

  std::size_t kept = 0;
  for (std::size_t c = 0; c < plane_chunks; ++c) {
    for (std::size_t k = 0; k < plane_counts[c]; ++k)
      normalised[kept++] = normalised[c * kChunk + k];
  }
  normalised.resize(kept);
  matches.scale = kept == 0 ? 1 : robust_scale(normalised);
  compact(planes, plane_counts);
  compact(matches.line_1, line_counts);
  compact(matches.line_2, line_counts);
  matches.standing_planes = 0;
  for (const std::size_t count : standing) matches.standing_planes += count;
}

}  // namespace traverse::voxel_map
