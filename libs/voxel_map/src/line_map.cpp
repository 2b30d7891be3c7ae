#include "traverse/voxel_map/line_map.hpp"

namespace traverse::voxel_map {

void bind(config::Binder& b, LineMapOptions& o) {
  using config::Range;
  b.number("cell_m", o.cell_m, Range::between(0.3, 5), "edge of a cell");
  b.integer("min_points", o.min_points, Range::between(3, 1000),
            "points that a cell needs for a line");
  b.integer("min_frames", o.min_frames, Range::between(1, 100), "frames in which a line was seen");
  b.number("refit_growth", o.refit_growth, Range::between(1, 10),
           "a line is fitted again when its points have grown by this factor");
  b.number("slenderness", o.fit.slenderness, Range::between(0, 1),
           "middle eigenvalue at most this times the largest");
  b.number("min_length_m", o.fit.min_length_m, Range::non_negative(),
           "standard deviation along a line at least");
}

void LineMap::insert(const LocalPoints& points) {
  ++inserts_;
  touched_.clear();
  const CellGrid at = grid(points.origin_map);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float p[3] = {points.x[i], points.y[i], points.z[i]};
    const std::int32_t c[3] = {at.cell(p[0], 0), at.cell(p[1], 1), at.cell(p[2], 2)};
    const std::uint32_t index =
        find_or_add(c[0] + at.base[0], c[1] + at.base[1], c[2] + at.base[2]);
    ColdCell& cell = cold_[index];
    cell.moments.add(p[0] - at.centre(c[0], 0), p[1] - at.centre(c[1], 1),
                     p[2] - at.centre(c[2], 2));
    cell.inserted += (static_cast<float>(inserts_) - cell.inserted) / cell.moments.n;
    if (cell.touched == inserts_) continue;
    cell.touched = inserts_;
    ++cell.frames;
    touched_.push_back(index);
  }
  for (const std::uint32_t cell : touched_) refit(cell);
}

std::uint32_t LineMap::find_or_add(std::int32_t x, std::int32_t y, std::int32_t z) {
  const auto next = static_cast<std::uint32_t>(cold_.size());
  const std::uint32_t index = table_.find_or_add(cell_key(x, y, z), next);
  if (index == next) {
    cold_.push_back({{}, 0, 0, 0, 0, {x, y, z}});
    lines_.emplace_back();
  }
  return index;
}

void LineMap::refit(std::uint32_t index) {
  constexpr float kMostPoints = 4096;
  ColdCell& cell = cold_[index];
  const auto least = static_cast<float>(options_.min_points);
  const auto growth = static_cast<float>(options_.refit_growth);
  if (cell.moments.n < least || cell.moments.n < growth * cell.fitted_n ||
      cell.frames < options_.min_frames) {
    return;
  }
  cell.fitted_n = cell.moments.n;
  const auto line = fit_line(cell.moments, options_.fit);
  lines_[index].is_line = line.has_value();
  lines_[index].inserted = cell.inserted;
  if (line) lines_[index].line = *line;
  if (cell.moments.n > kMostPoints) {
    cell.moments.forget_half();
    cell.fitted_n *= 0.5F;
  }
}

bool LineMap::find(const CellGrid& at, const RelativeCell& c, Answer& answer) const {
  const std::uint32_t index =
      table_.find(cell_key(c.x + at.base[0], c.y + at.base[1], c.z + at.base[2]));
  if (index == CellTable::kNone) return false;
  const LineCell& cell = lines_[index];
  if (!cell.is_line) return false;
  const Eigen::Vector3f centre(at.centre(c.x, 0), at.centre(c.y, 1), at.centre(c.z, 2));
  const FittedLine& line = cell.line;
  for (int k = 0; k < 3; ++k) {
    answer.n1[k] = line.normal_1[k];
    answer.n2[k] = line.normal_2[k];
  }
  answer.d1 = line.offset_1 - line.normal_1.dot(centre);
  answer.d2 = line.offset_2 - line.normal_2.dot(centre);
  answer.variance = line.variance;
  answer.age = static_cast<float>(inserts_ + 1) - cell.inserted;
  return true;
}

void LineMap::prefetch(const CellGrid& at, const RelativeCell& c) const {
  table_.prefetch(cell_key(c.x + at.base[0], c.y + at.base[1], c.z + at.base[2]));
}

void LineMap::keep_near(const Eigen::Vector3d& centre_map, double radius_m) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < cold_.size(); ++k) {
    const auto& c = cold_[k].number;
    const Eigen::Vector3d middle = cell_centre(c[0], c[1], c[2], options_.cell_m);
    if ((middle - centre_map).squaredNorm() > radius_m * radius_m) continue;
    cold_[kept] = cold_[k];
    lines_[kept++] = lines_[k];
  }
  cold_.resize(kept);
  lines_.resize(kept);
  table_.clear(kept);
  for (std::uint32_t k = 0; k < kept; ++k) {
    const auto& c = cold_[k].number;
    table_.find_or_add(cell_key(c[0], c[1], c[2]), k);
  }
}

std::vector<Eigen::Vector3d> LineMap::points() const {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t k = 0; k < cold_.size(); ++k) {
    if (!lines_[k].is_line) continue;
    const auto& c = cold_[k].number;
    points.push_back(cell_centre(c[0], c[1], c[2], options_.cell_m) + cold_[k].moments.mean());
  }
  return points;
}

std::size_t LineMap::bytes() const {
  return table_.bytes() + cold_.capacity() * sizeof(ColdCell) +
         lines_.capacity() * sizeof(LineCell) + touched_.capacity() * sizeof(std::uint32_t);
}

}  // namespace traverse::voxel_map
