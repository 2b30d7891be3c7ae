#!/usr/bin/env bash
# nanoflann: its metrics for rotations do not find the nearest one. That for SO(2) keeps the sign of the difference, so
# that almost half a turn to one side counts as nearest; that for SO(3) takes q and -q, the same attitude, for the
# farthest apart. Needs g++.
source "$(dirname "$0")/install.sh"
debian libnanoflann-dev=1.4.3+ds-2
cxx <<'CXX'
#include <nanoflann.hpp>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>
template <int Size> struct Rotations {
  std::vector<std::array<double, Size>> all;
  std::size_t kdtree_get_point_count() const { return all.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t part) const { return all[i][part]; }
  template <class Box> bool kdtree_get_bbox(Box&) const { return false; }
};
template <template <class, class> class Metric, int Size>
std::size_t nearest(const Rotations<Size>& rotations, const std::array<double, Size>& query) {
  nanoflann::KDTreeSingleIndexAdaptor<Metric<double, Rotations<Size>>, Rotations<Size>, Size> tree(Size, rotations);
  tree.buildIndex();
  std::uint32_t index = 0;
  double distance = 0;
  tree.knnSearch(query.data(), 1, &index, &distance);
  return index;
}
template <class T, class Source> using SO2 = nanoflann::SO2_Adaptor<T, Source>;
template <class T, class Source> using SO3 = nanoflann::SO3_Adaptor<T, Source>;
int main() {
  Rotations<1> headings;
  for (int degrees = -180; degrees < 180; ++degrees) headings.all.push_back({degrees * M_PI / 180});
  const int found = int(nearest<SO2, 1>(headings, {10.4 * M_PI / 180})) - 180;
  const Rotations<4> turns{{{0, 0, std::sqrt(0.5), std::sqrt(0.5)}, {0, 0, 0, 1}}}; // x, y, z, w
  std::printf("to 10.4 degrees %d; to no turn, written 0 0 0 -1, a turn of %d", found,
              nearest<SO3, 4>(turns, {0, 0, 0, -1}) == 0 ? 90 : 0);
}
CXX
report "nanoflann 1.4.3, nearest of the headings -180, -179 ... 179 and of turns of 90 and 0 degrees" \
  "to 10.4 degrees 10; to no turn, written 0 0 0 -1, a turn of 0" "$("$tmp/probe")" \
  "to 10.4 degrees -169; to no turn, written 0 0 0 -1, a turn of 90"
