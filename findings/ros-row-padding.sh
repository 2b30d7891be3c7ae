#!/usr/bin/env bash
# ROS 1: the C++ iterator over a PointCloud2 steps over row padding as if it were points, so the rows after the first
# are wrong and there are too many of them; Debian's Python reader of the same message is right. Needs g++, python3.
source "$(dirname "$0")/install.sh"
debian_with_dependencies libsensor-msgs-dev=1.13.1-1+b1 python3-sensor-msgs=1.13.1-1 python3-roslib=1.15.8-3
cxx <<'CXX'
#include <sensor_msgs/point_cloud2_iterator.h>
#include <cstdio>
int main() { // two rows of three points; a row is 36 bytes of points and 12 bytes of padding
  sensor_msgs::PointCloud2 cloud;
  sensor_msgs::PointCloud2Modifier(cloud).setPointCloud2Fields(
      3, "x", 1, sensor_msgs::PointField::FLOAT32, "y", 1, sensor_msgs::PointField::FLOAT32, "z", 1,
      sensor_msgs::PointField::FLOAT32);
  cloud.height = 2;
  cloud.width = 3;
  cloud.row_step = 48;
  cloud.data.assign(96, 0);
  for (int row = 0; row < 2; ++row)
    for (int column = 0; column < 3; ++column) {
      const float x = 10 * (row + 1) + column;
      std::memcpy(&cloud.data[48 * row + cloud.point_step * column], &x, 4);
    }
  for (sensor_msgs::PointCloud2ConstIterator<float> x(cloud, "x"); x != x.end(); ++x) std::printf("%g ", *x);
}
CXX
seen="C++: $("$tmp/probe"); Python: $(python3 - <<'PY'
import struct
from sensor_msgs.msg import PointCloud2, PointField
from sensor_msgs.point_cloud2 import read_points
rows = [b"".join(struct.pack("<3f", 10 * r + c, 0, 0) for c in range(3)) + bytes(12) for r in (1, 2)]
fields = [PointField(name, 4 * i, PointField.FLOAT32, 1) for i, name in enumerate("xyz")]
cloud = PointCloud2(height=2, width=3, point_step=12, row_step=48, fields=fields, data=b"".join(rows))
print(*("%g" % point[0] for point in read_points(cloud)))
PY
)"
report "ROS sensor_msgs 1.13.1, x of two padded rows" "C++: 10 11 12 20 21 22; Python: 10 11 12 20 21 22" "$seen" \
  "C\+\+: 10 11 12 0 20 21 22 0 ; Python: 10 11 12 20 21 22"
