#pragma once

#include <span>
#include <vector>

#include "traverse/render/rect.hpp"

namespace traverse::render {

/// Which places of a picture carry data, in cells of a few pixels: to put legends elsewhere.
class Occupancy {
 public:
  Occupancy(int width, int height);

  void add(Point p);
  /// Marks a line through `points`; points that are not finite interrupt it.
  void add_line(std::span<const Point> points);

  /// Share of the cells under `rect` that carry data.
  double share(const Rect& rect) const;
  bool is_free(const Rect& rect) const { return share(rect) == 0; }

 private:
  static constexpr int kCell = 6;

  struct Cells {
    int first_column, last_column, first_row, last_row;
  };
  Cells cells_under(const Rect& rect) const;

  int columns_;
  int rows_;
  std::vector<char> taken_;
};

}  // namespace traverse::render
