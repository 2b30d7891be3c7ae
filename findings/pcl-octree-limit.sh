#!/usr/bin/env bash
# PCL: a radius search with a limit gives the nearest points from a KdTreeFLANN and the first that it meets from an
# octree, here the farthest; both describe the limit in the same words. Needs g++.
source "$(dirname "$0")/install.sh"
debian libpcl-dev=1.13.0+dfsg-3 libflann-dev=1.9.2+dfsg-1+deb12u1
debian_with_dependencies libpcl-octree1.13=1.13.0+dfsg-3 libpcl-kdtree1.13=1.13.0+dfsg-3 libeigen3-dev=3.4.0-4 \
  libboost1.74-dev=1.74.0+ds1-21
cxx -I "$root/usr/include/pcl-1.13" -lpcl_octree -lpcl_kdtree -lpcl_common <<'CXX'
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/octree/octree_search.h>
#include <pcl/point_types.h>
#include <cmath>
#include <cstdio>
int main() {
  pcl::PointCloud<pcl::PointXYZ>::Ptr wall(new pcl::PointCloud<pcl::PointXYZ>);
  for (int i = 0; i < 200; ++i) wall->push_back({i * 0.01f, 0, 0});
  const pcl::PointXYZ query(1, 0, 0);
  pcl::Indices indices;
  std::vector<float> squares;
  pcl::KdTreeFLANN<pcl::PointXYZ> tree;
  tree.setInputCloud(wall);
  tree.radiusSearch(query, 0.5, indices, squares, 5);
  std::printf("%.2f m (KdTreeFLANN)", std::sqrt(squares.back()));
  pcl::octree::OctreePointCloudSearch<pcl::PointXYZ> octree(0.1);
  octree.setInputCloud(wall);
  octree.addPointsFromInputCloud();
  octree.radiusSearch(query, 0.5, indices, squares, 5);
  std::printf(" %.2f m (octree)", std::sqrt(*std::max_element(squares.begin(), squares.end())));
}
CXX
report "PCL 1.13.0, at most 5 points within 0.5 m, of a row 0.01 m apart: the farthest" \
  "0.02 m (KdTreeFLANN) 0.02 m (octree)" "$("$tmp/probe")" "0.02 m \(KdTreeFLANN\) 0.[45]. m \(octree\)"
