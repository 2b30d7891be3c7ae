#!/usr/bin/env bash
# PCL: VoxelGrid of a PCLPointCloud2 (what ROS's voxel filter runs) averages the bits of a whole-number field as if
# they were a float: two points at 1 ms and 99 ms get the time 90.6 ms. Needs g++.
source "$(dirname "$0")/install.sh"
debian libpcl-dev=1.13.0+dfsg-3
debian_with_dependencies libpcl-filters1.13=1.13.0+dfsg-3 libeigen3-dev=3.4.0-4 libboost1.74-dev=1.74.0+ds1-21
cxx -I "$root/usr/include/pcl-1.13" -lpcl_filters -lpcl_common <<'CXX'
#include <pcl/filters/voxel_grid.h>
#include <cstdio>
#include <cstring>
int main() {
  pcl::PCLPointCloud2::Ptr scan(new pcl::PCLPointCloud2);
  const char* names[] = {"x", "y", "z", "t"};
  for (int i = 0; i < 4; ++i) {
    pcl::PCLPointField field;
    field.name = names[i];
    field.offset = 4 * i;
    field.count = 1;
    field.datatype = i < 3 ? pcl::PCLPointField::FLOAT32 : pcl::PCLPointField::UINT32;
    scan->fields.push_back(field);
  }
  const std::uint32_t nanoseconds[] = {1000000, 99000000};
  for (int i = 0; i < 2; ++i) {
    const float place[] = {1.1f + 0.2f * i, 1.1f, 0.1f};
    scan->data.resize(16 * (i + 1));
    std::memcpy(&scan->data[16 * i], place, 12);
    std::memcpy(&scan->data[16 * i + 12], &nanoseconds[i], 4);
  }
  scan->height = 1;
  scan->width = 2;
  scan->point_step = 16;
  scan->row_step = 32;
  pcl::VoxelGrid<pcl::PCLPointCloud2> filter;
  filter.setInputCloud(scan);
  filter.setLeafSize(1, 1, 1);
  pcl::PCLPointCloud2 out;
  filter.filter(out);
  float x;
  std::uint32_t t;
  std::memcpy(&x, &out.data[0], 4);
  std::memcpy(&t, &out.data[12], 4);
  std::printf("one point, x %.2f, t %u ns", x, t);
}
CXX
report "PCL 1.13.0" "one point, x 1.20, t 50000000 ns" "$("$tmp/probe")" "one point, x 1.20, t 906[0-9]{5} ns"
