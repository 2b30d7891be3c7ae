#include "plot/decimation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace traverse::render {

namespace {

void keep_extremes(std::span<const Point> column, std::vector<Point>& kept) {
  const auto [lowest, highest] =
      std::minmax_element(column.begin(), column.end(), [](Point a, Point b) { return a.y < b.y; });
  std::array<std::span<const Point>::iterator, 4> chosen{column.begin(), lowest, highest,
                                                         column.end() - 1};
  std::sort(chosen.begin(), chosen.end());
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (i == 0 || chosen[i] != chosen[i - 1]) kept.push_back(*chosen[i]);
  }
}

}  // namespace

std::vector<Point> decimated(std::span<const Point> points, double column_width) {
  std::vector<Point> kept;
  std::size_t begin = 0;
  while (begin < points.size()) {
    if (!is_finite(points[begin])) {
      kept.push_back(points[begin++]);
      continue;
    }
    const double column = std::floor(points[begin].x / column_width);
    std::size_t end = begin + 1;
    while (end < points.size() && is_finite(points[end]) &&
           std::floor(points[end].x / column_width) == column) {
      ++end;
    }
    keep_extremes(points.subspan(begin, end - begin), kept);
    begin = end;
  }
  return kept;
}

}  // namespace traverse::render
