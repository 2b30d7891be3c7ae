#include "plot/occupancy.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::render {

Occupancy::Occupancy(int width, int height)
    : columns_(width / kCell + 1),
      rows_(height / kCell + 1),
      taken_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0) {}

void Occupancy::add(Point p) {
  if (!is_finite(p) || p.x < 0 || p.y < 0 || p.x >= columns_ * kCell || p.y >= rows_ * kCell)
    return;
  const auto column = static_cast<std::size_t>(p.x / kCell);
  const auto row = static_cast<std::size_t>(p.y / kCell);
  taken_[row * static_cast<std::size_t>(columns_) + column] = 1;
}

void Occupancy::add_line(std::span<const Point> points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    add(points[i]);
    if (i == 0 || !is_finite(points[i - 1]) || !is_finite(points[i])) continue;
    const Point step = points[i] - points[i - 1];
    const double length = std::hypot(step.x, step.y);
    const double most = 2.0 * (columns_ + rows_) * kCell;  // longer is outside for the most part
    const auto pieces = static_cast<int>(std::min(length, most) / kCell) + 1;
    for (int k = 1; k < pieces; ++k) add(points[i - 1] + (double{1} * k / pieces) * step);
  }
}

double Occupancy::share(const Rect& rect) const {
  const Cells cells = cells_under(rect);
  int count = 0;
  int taken = 0;
  for (int row = cells.first_row; row <= cells.last_row; ++row) {
    for (int column = cells.first_column; column <= cells.last_column; ++column) {
      ++count;
      taken += taken_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                      static_cast<std::size_t>(column)];
    }
  }
  return count == 0 ? 0 : static_cast<double>(taken) / count;
}

Occupancy::Cells Occupancy::cells_under(const Rect& rect) const {
  const auto cell = [](double position, int count) {
    return static_cast<int>(std::clamp(std::floor(position / kCell), 0.0, count - 1.0));
  };
  return {cell(rect.left, columns_), cell(rect.right, columns_), cell(rect.top, rows_),
          cell(rect.bottom, rows_)};
}

}  // namespace traverse::render
