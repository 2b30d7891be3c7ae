#include "traverse/voxel_map/plane_map.hpp"

#include <algorithm>

#include "traverse/parallel/workers.hpp"

#include "point_hash.hpp"

namespace traverse::voxel_map {

namespace {

constexpr std::uint32_t kNone = CellTable::kNone;
constexpr std::int32_t kParent = 3;                 // fine cells along an edge of a coarse one
constexpr std::int32_t kFar = kParent * (1 << 24);  // makes any cell number positive
constexpr float kMostPoints = 4096;  // in the sums of a cell; then the old ones count half

std::int32_t parent_of(std::int32_t cell) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(cell + kFar) / kParent) -
         kFar / kParent;
}

/// Coarse cells are dealt out by a hash that is not the one of the tables.
std::size_t shard_of(std::int32_t px, std::int32_t py, std::int32_t pz) {
  const std::uint32_t mixed = static_cast<std::uint32_t>(px) * 73856093U ^
                              static_cast<std::uint32_t>(py) * 19349663U ^
                              static_cast<std::uint32_t>(pz) * 83492791U;
  return spread(mixed) >> 28U;
}

}  // namespace

void bind(config::Binder& b, PlaneMapOptions& o) {
  using config::Range;
  // Cell numbers wrap after 2048 cells; a cell of 0.3 m and the radius below 150 m stay within.
  b.number("cell_m", o.cell_m, Range::between(0.3, 5),
           "edge of a cell; its parent is 3 times as wide");
  b.integer("min_points", o.min_points, Range::between(4, 1000),
            "points that a cell needs for a plane");
  b.number("refit_growth", o.refit_growth, Range::between(1, 10),
           "a plane is fitted again when its points have grown by this factor");
  b.number("flatness", o.fit.flatness, Range::between(0, 1),
           "smallest eigenvalue at most this times the middle one");
  b.number("thickness_m", o.fit.thickness_m, Range::positive(),
           "standard deviation of the points across a plane at most");
  b.number("min_width_m", o.fit.min_width_m, Range::non_negative(),
           "standard deviation along the shorter side at least");
}

PlaneMap::PlaneMap(const PlaneMapOptions& options) : options_(options) {}

void PlaneMap::insert(const LocalPoints& points, parallel::Workers& workers) {
  constexpr std::size_t kChunk = 4096;
  ++inserts_;
  runs_.resize((points.size() + kChunk - 1) / kChunk);
  workers.run_chunks(points.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    collect_runs(points, begin, end, runs_[begin / kChunk]);
  });
  workers.run(kShards, [&](std::size_t s) {
    Shard& shard = shards_[s];
    shard.touched_fine.clear();
    shard.touched_coarse.clear();
    for (const auto& runs : runs_) insert_runs(shard, runs[s]);
    for (const std::uint32_t cell : shard.touched_fine) refit(shard.fine, cell, options_.cell_m);
    for (const std::uint32_t cell : shard.touched_coarse) {
      refit(shard.coarse, cell, kParent * options_.cell_m);
    }
  });
}

void PlaneMap::collect_runs(const LocalPoints& points, std::size_t begin, std::size_t end,
                            std::array<std::vector<Run>, kShards>& runs) const {
  for (auto& list : runs) list.clear();
  const CellGrid at = grid(points.origin_map);
  Run run{{0, 0, 0}, {}};
  std::int32_t cell[3] = {0, 0, 0};
  float centre[3] = {0, 0, 0};
  const auto end_run = [&] {
    if (run.moments.n == 0) return;
    run.number = {cell[0] + at.base[0], cell[1] + at.base[1], cell[2] + at.base[2]};
    const std::size_t shard =
        shard_of(parent_of(run.number.x), parent_of(run.number.y), parent_of(run.number.z));
    runs[shard].push_back(run);
  };
  for (std::size_t i = begin; i < end; ++i) {
    const float p[3] = {points.x[i], points.y[i], points.z[i]};
    const std::int32_t next[3] = {at.cell(p[0], 0), at.cell(p[1], 1), at.cell(p[2], 2)};
    if (next[0] != cell[0] || next[1] != cell[1] || next[2] != cell[2] || i == begin) {
      end_run();
      run.moments = {};
      for (int axis = 0; axis < 3; ++axis) {
        cell[axis] = next[axis];
        centre[axis] = at.centre(next[axis], axis);
      }
    }
    run.moments.add(p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]);
  }
  end_run();
}

std::uint32_t PlaneMap::fine_cell(Shard& shard, const CellNumber& c) const {
  const std::size_t known = shard.fine.cold.size();
  const std::uint32_t fine = shard.fine.find_or_add(c);
  if (fine == known) {
    const CellNumber p{parent_of(c.x), parent_of(c.y), parent_of(c.z)};
    shard.fine.planes[fine].parent = shard.coarse.find_or_add(p);
  }
  return fine;
}

void PlaneMap::insert_runs(Shard& shard, const std::vector<Run>& runs) const {
  // In two passes, each fetching ahead what it will touch.
  constexpr std::size_t kAhead = 8;
  shard.cells.resize(runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (i + kAhead < runs.size()) {
      const CellNumber& c = runs[i + kAhead].number;
      shard.fine.table.prefetch(cell_key(c.x, c.y, c.z));
    }
    shard.cells[i] = fine_cell(shard, runs[i].number);
  }
  const auto cell_m = static_cast<float>(options_.cell_m);
  const auto now = static_cast<float>(inserts_);
  const auto date = [&](ColdCell& cell, float points) {
    cell.inserted += (now - cell.inserted) * (points / cell.moments.n);
  };
  const auto touch = [&](ColdCell& cell, std::uint32_t index, std::vector<std::uint32_t>& touched) {
    if (cell.touched == inserts_) return;
    cell.touched = inserts_;
    touched.push_back(index);
  };
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (i + kAhead < runs.size()) {
      const std::uint32_t ahead = shard.cells[i + kAhead];
      __builtin_prefetch(&shard.fine.cold[ahead], 1);
      __builtin_prefetch(&shard.fine.planes[ahead]);
    }
    const std::uint32_t fine = shard.cells[i];
    const std::uint32_t coarse = shard.fine.planes[fine].parent;
    ColdCell& cell = shard.fine.cold[fine];
    cell.moments.add(runs[i].moments);
    date(cell, runs[i].moments.n);
    touch(cell, fine, shard.touched_fine);

    // From the middle fine cell of the parent, in whole cells.
    const CellNumber& c = runs[i].number;
    const CellNumber& p = shard.coarse.numbers[coarse];
    const auto offset = [&](std::int32_t number, std::int32_t parent_number) {
      return static_cast<float>(number - kParent * parent_number - 1) * cell_m;
    };
    ColdCell& parent = shard.coarse.cold[coarse];
    parent.moments.add_shifted(runs[i].moments, offset(c.x, p.x), offset(c.y, p.y),
                               offset(c.z, p.z));
    date(parent, runs[i].moments.n);
    touch(parent, coarse, shard.touched_coarse);
  }
}

void PlaneMap::refit(Level& level, std::uint32_t index, double cell_m) const {
  ColdCell& cell = level.cold[index];
  const auto least = static_cast<float>(options_.min_points);
  const auto growth = static_cast<float>(options_.refit_growth);
  if (cell.moments.n < least || cell.moments.n < growth * cell.fitted_n) return;
  cell.fitted_n = cell.moments.n;
  PlaneFitOptions fit = options_.fit;
  fit.min_width_m *= cell_m / options_.cell_m;
  PlaneCell& plane = level.planes[index];
  const auto fitted = fit_plane(cell.moments, fit);
  plane.is_plane = fitted ? 1 : 0;
  if (fitted) {
    plane.nx = fitted->normal.x();
    plane.ny = fitted->normal.y();
    plane.nz = fitted->normal.z();
    plane.d = fitted->offset;
    plane.variance = fitted->variance;
    plane.inserted = cell.inserted;
  }
  if (cell.moments.n > kMostPoints) {
    cell.moments.forget_half();
    cell.fitted_n *= 0.5F;
  }
}

bool PlaneMap::find(const CellGrid& at, const RelativeCell& cell, Answer& answer) const {
  const std::int32_t cx = cell.x + at.base[0];
  const std::int32_t cy = cell.y + at.base[1];
  const std::int32_t cz = cell.z + at.base[2];
  const std::int32_t px = parent_of(cx);
  const std::int32_t py = parent_of(cy);
  const std::int32_t pz = parent_of(cz);
  const Shard& shard = shards_[shard_of(px, py, pz)];
  const auto tell = [&](const PlaneCell& plane, float mx, float my, float mz) {
    const float offset = plane.d - plane.nx * mx - plane.ny * my - plane.nz * mz;
    const float age = static_cast<float>(inserts_ + 1) - plane.inserted;
    answer = {plane.nx, plane.ny, plane.nz, offset, plane.variance, age};
  };
  const std::uint32_t fine = shard.fine.table.find(cell_key(cx, cy, cz));
  std::uint32_t coarse = kNone;
  if (fine != kNone) {
    const PlaneCell& plane = shard.fine.planes[fine];
    if (plane.is_plane != 0) {
      tell(plane, at.centre(cell.x, 0), at.centre(cell.y, 1), at.centre(cell.z, 2));
      return true;
    }
    coarse = plane.parent;
  } else {
    coarse = shard.coarse.table.find(cell_key(px, py, pz));
  }
  if (coarse == kNone || shard.coarse.planes[coarse].is_plane == 0) return false;
  // The parent's centre is that of its middle fine cell.
  tell(shard.coarse.planes[coarse], at.centre(kParent * px + 1 - at.base[0], 0),
       at.centre(kParent * py + 1 - at.base[1], 1), at.centre(kParent * pz + 1 - at.base[2], 2));
  return true;
}

void PlaneMap::prefetch(const CellGrid& at, const RelativeCell& cell) const {
  const std::int32_t cx = cell.x + at.base[0];
  const std::int32_t cy = cell.y + at.base[1];
  const std::int32_t cz = cell.z + at.base[2];
  const Shard& shard = shards_[shard_of(parent_of(cx), parent_of(cy), parent_of(cz))];
  shard.fine.table.prefetch(cell_key(cx, cy, cz));
}

void PlaneMap::prefetch_plane(const CellGrid& at, const RelativeCell& cell) const {
  const std::int32_t cx = cell.x + at.base[0];
  const std::int32_t cy = cell.y + at.base[1];
  const std::int32_t cz = cell.z + at.base[2];
  const Shard& shard = shards_[shard_of(parent_of(cx), parent_of(cy), parent_of(cz))];
  const std::uint32_t fine = shard.fine.table.find(cell_key(cx, cy, cz));
  if (fine != kNone) __builtin_prefetch(&shard.fine.planes[fine]);
}

void PlaneMap::keep_near(const Eigen::Vector3d& centre_map, double radius_m,
                         parallel::Workers& workers) {
  const double coarse_m = kParent * options_.cell_m;
  workers.run(kShards, [&](std::size_t s) {
    Level& coarse = shards_[s].coarse;
    Level& fine = shards_[s].fine;
    std::vector<std::uint32_t> moved_to(coarse.cold.size(), kNone);
    std::uint32_t kept = 0;
    for (std::uint32_t k = 0; k < coarse.cold.size(); ++k) {
      const CellNumber& c = coarse.numbers[k];
      const Eigen::Vector3d middle = cell_centre(c.x, c.y, c.z, coarse_m);
      if ((middle - centre_map).squaredNorm() > radius_m * radius_m) continue;
      coarse.move(k, kept);
      moved_to[k] = kept++;
    }
    coarse.keep_first(kept);
    std::size_t fine_kept = 0;
    for (std::size_t k = 0; k < fine.cold.size(); ++k) {
      const std::uint32_t parent = moved_to[fine.planes[k].parent];
      if (parent == kNone) continue;
      fine.move(k, fine_kept);
      fine.planes[fine_kept++].parent = parent;
    }
    fine.keep_first(fine_kept);
  });
}

std::vector<Eigen::Vector3d> PlaneMap::points() const {
  std::vector<Eigen::Vector3d> points;
  for (const Shard& shard : shards_) {
    const Level& fine = shard.fine;
    for (std::size_t k = 0; k < fine.cold.size(); ++k) {
      const PlaneCell& plane = fine.planes[k];
      if (plane.is_plane == 0 && shard.coarse.planes[plane.parent].is_plane == 0) continue;
      const CellNumber& c = fine.numbers[k];
      points.push_back(cell_centre(c.x, c.y, c.z, options_.cell_m) + fine.cold[k].moments.mean());
    }
  }
  return points;
}

std::size_t PlaneMap::size() const {
  std::size_t cells = 0;
  for (const Shard& shard : shards_) cells += shard.fine.cold.size();
  return cells;
}

std::size_t PlaneMap::bytes() const {
  std::size_t bytes = 0;
  for (const Shard& shard : shards_) {
    bytes += shard.fine.bytes() + shard.coarse.bytes();
  }
  for (const auto& chunk : runs_) {
    for (const auto& runs : chunk) bytes += runs.capacity() * sizeof(Run);
  }
  return bytes;
}

}  // namespace traverse::voxel_map
