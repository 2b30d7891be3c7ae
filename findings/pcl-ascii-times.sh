#!/usr/bin/env bash
# PCL: files written as text have eight digits, whatever a field's type: times of points as doubles (Hesai, RoboSense,
# the poses of LIO-SAM) are rounded to a hundred seconds, in PCD and in PLY. Needs g++.
source "$(dirname "$0")/install.sh"
debian libpcl-dev=1.13.0+dfsg-3
debian_with_dependencies libpcl-io1.13=1.13.0+dfsg-3 libeigen3-dev=3.4.0-4 libboost1.74-dev=1.74.0+ds1-21
cxx -I "$root/usr/include/pcl-1.13" -lpcl_io -lpcl_io_ply -lpcl_common <<'CXX'
#define PCL_NO_PRECOMPILE
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>
#include <cstdio>
struct EIGEN_ALIGN16 Return {
  PCL_ADD_POINT4D;
  double timestamp;
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};
POINT_CLOUD_REGISTER_POINT_STRUCT(Return, (float, x, x)(float, y, y)(float, z, z)(double, timestamp, timestamp))
using Cloud = pcl::PointCloud<Return>;
void print(const char* name, const Cloud& back) {
  std::printf("%s %.2f %.2f", name, back[0].timestamp, back[1].timestamp);
}
int main() {
  Cloud cloud, back;
  cloud.resize(2);
  cloud[0].timestamp = 1700000000.25;
  cloud[1].timestamp = 1700000060.35;
  pcl::io::savePCDFileBinary("points.pcd", cloud);
  pcl::io::loadPCDFile("points.pcd", back);
  print("binary PCD", back);
  pcl::io::savePCDFileASCII("points.pcd", cloud);
  pcl::io::loadPCDFile("points.pcd", back);
  print("; PCD as text", back);
  pcl::io::savePLYFileASCII("points.ply", cloud);
  pcl::io::loadPLYFile("points.ply", back);
  print("; PLY as text", back);
}
CXX
cd "$tmp"
report "PCL 1.13.0, times of two points" \
  "binary PCD 1700000000.25 1700000060.35; PCD as text and PLY as text the same" "$("$tmp/probe" 2>/dev/null)" \
  "binary PCD 1700000000.25 1700000060.35; PCD as text 1700000000.00 17000001.*; PLY as text 1700000000.00 17000001.*"
