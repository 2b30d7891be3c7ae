#!/usr/bin/env bash
# PCL: the centroid of a large cloud lies outside the cloud. Sums are kept in float32, so beyond some million points
# what is added is lost. Needs g++.
source "$(dirname "$0")/install.sh"
debian libpcl-dev=1.13.0+dfsg-3
debian_with_dependencies libpcl-common1.13=1.13.0+dfsg-3 libeigen3-dev=3.4.0-4 libboost1.74-dev=1.74.0+ds1-21
cxx -I "$root/usr/include/pcl-1.13" -lpcl_common <<'CXX'
#include <pcl/common/centroid.h>
#include <pcl/point_types.h>
#include <cstdio>
int main() {
  pcl::PointCloud<pcl::PointXYZ> map;
  for (int i = 0; i < 5000000; ++i) map.push_back({100.0f + i % 2, 0, 0});
  Eigen::Vector4f centroid;
  pcl::compute3DCentroid(map, centroid);
  std::printf("%.1f", centroid.x());
}
CXX
report "PCL 1.13.0, compute3DCentroid of 5 million points with x of 100 and 101 in turn" \
  "100.5" "$("$tmp/probe")" "97\..*"
