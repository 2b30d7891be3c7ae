#!/usr/bin/env bash
# PCL: an ICP that was stopped by its limit of iterations says that it converged, metres away. Needs g++.
source "$(dirname "$0")/install.sh"
debian libpcl-dev=1.13.0+dfsg-3 libflann-dev=1.9.2+dfsg-1+deb12u1
debian_with_dependencies libpcl-registration1.13=1.13.0+dfsg-3 libeigen3-dev=3.4.0-4 libboost1.74-dev=1.74.0+ds1-21
cxx -I "$root/usr/include/pcl-1.13" -lpcl_registration -lpcl_search -lpcl_kdtree -lpcl_octree -lpcl_common <<'CXX'
#include <pcl/point_types.h>
#include <pcl/registration/icp.h>
#include <cstdio>
#include <random>
int main() {
  using Cloud = pcl::PointCloud<pcl::PointXYZ>;
  Cloud::Ptr source(new Cloud), target(new Cloud);
  std::mt19937 random(1);
  const auto uniform = [&] { return random() / 4294967296.0f * 20 - 10; };
  for (int i = 0; i < 500; ++i) {
    const float x = uniform(), y = uniform(), z = uniform();
    source->push_back({x, y, z});
    target->push_back({x + 4, y + 3, z});
  }
  pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> icp;
  icp.setInputSource(source);
  icp.setInputTarget(target);
  icp.setMaximumIterations(1);
  Cloud moved;
  icp.align(moved);
  const double error = (icp.getFinalTransformation().topRightCorner<3, 1>() - Eigen::Vector3f(4, 3, 0)).norm();
  std::printf("hasConverged() is %s with an error of %.1f m", icp.hasConverged() ? "true" : "false", error);
}
CXX
report "PCL 1.13.0, ICP with at most 1 iteration from 5 m away" "hasConverged() is false with an error of some metres" \
  "$("$tmp/probe")" "hasConverged\(\) is true with an error of [2-5]\.. m"
