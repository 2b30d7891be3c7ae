#!/usr/bin/env bash
# OctoMap: one scan of a wall at a grazing angle, put in ray by ray, erases the wall: each ray marks as free the cells
# that the rays before it ended in. insertPointCloud keeps it. Needs g++.
source "$(dirname "$0")/install.sh"
debian liboctomap-dev=1.9.7+dfsg-3+b1 liboctomap1.9=1.9.7+dfsg-3+b1
cxx -loctomap -loctomath <<'CXX'
#include <octomap/octomap.h>
#include <cstdio>
int occupied(const octomap::OcTree& tree) {
  int count = 0;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) count += tree.isNodeOccupied(*leaf);
  return count;
}
int main() {
  const octomap::point3d sensor(0, 0.65f, 0);
  octomap::Pointcloud wall;
  for (int i = 0; i < 2000; ++i) wall.push_back(1 + i * 0.02f, 0.55f, 0);
  octomap::OcTree whole(0.1), single(0.1);
  whole.insertPointCloud(wall, sensor);
  for (const auto& point : wall) single.insertRay(sensor, point);
  std::printf("%d occupied cells from insertPointCloud, %d from insertRay", occupied(whole), occupied(single));
}
CXX
report "OctoMap 1.9.7, cells of 0.1 m, a wall of 40 m" "about 400 occupied cells either way" "$("$tmp/probe")" \
  "(39|40). occupied cells from insertPointCloud, [0-9] from insertRay"
