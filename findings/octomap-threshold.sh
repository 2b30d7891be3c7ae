#!/usr/bin/env bash
# OctoMap: the full-probability file (.ot) does not hold the occupancy threshold, so a cell that was free when the map
# was written is occupied when it is read. Needs g++.
source "$(dirname "$0")/install.sh"
debian liboctomap-dev=1.9.7+dfsg-3+b1 liboctomap1.9=1.9.7+dfsg-3+b1
cxx -loctomap -loctomath <<'CXX'
#include <octomap/octomap.h>
#include <cstdio>
#include <sstream>
int main() {
  octomap::OcTree tree(0.1);
  tree.setOccupancyThres(0.8);
  tree.updateNode(octomap::point3d(0, 0, 0), true); // one hit: probability 0.7
  std::stringstream file;
  tree.write(file);
  const auto* read = dynamic_cast<octomap::OcTree*>(octomap::AbstractOcTree::read(file));
  const auto* before = tree.search(0, 0, 0);
  const auto* after = read->search(0, 0, 0);
  std::printf("probability %.2f, threshold %.1f, %s; read back %.2f, %.1f, %s", before->getOccupancy(),
              tree.getOccupancyThres(), tree.isNodeOccupied(before) ? "occupied" : "free", after->getOccupancy(),
              read->getOccupancyThres(), read->isNodeOccupied(after) ? "occupied" : "free");
}
CXX
report "OctoMap 1.9.7" "probability 0.70, threshold 0.8, free; read back 0.70, 0.8, free" \
  "$("$tmp/probe" 2>/dev/null)" \
  "probability 0.70, threshold 0.8, free; read back 0.70, 0.5, occupied"
