#!/usr/bin/env bash
# ROS 1's Python reader of PointCloud2: values come in the order of their bytes, not of the fields asked for, nor of the
# message's list of fields. In the clouds that PCL's PointXYZINormal makes (FAST-LIO's), where that list has the
# intensity fourth, the fourth value is a normal's x. Needs python3.
source "$(dirname "$0")/install.sh"
debian_with_dependencies python3-sensor-msgs=1.13.1-1 python3-roslib=1.15.8-3
seen=$(cd "$tmp" && python3 - <<'PY'
import struct
from sensor_msgs import point_cloud2
from sensor_msgs.msg import PointCloud2, PointField
places = {"x": 0, "y": 4, "z": 8, "intensity": 32, "normal_x": 16, "normal_y": 20, "normal_z": 24, "curvature": 36}
cloud = PointCloud2(height=1, width=1, point_step=48, row_step=48)
cloud.fields = [PointField(name, at, PointField.FLOAT32, 1) for name, at in places.items()]
cloud.data = struct.pack("<12f", 1, 2, 3, 0, 0.6, 0, 0.8, 0, 100, 0.5, 0, 0)
def read(names):
    values = next(point_cloud2.read_points(cloud, names))
    return " ".join("%s %g" % pair for pair in zip(names or [field.name for field in cloud.fields], values))
print(read(("intensity", "x")) + ";", " ".join(read(None).split()[6:10]))
PY
)
report "python3-sensor-msgs 1.13.1, a point with x 1, intensity 100, normal 0.6 0.0 0.8" \
  "intensity 100 x 1; intensity 100 normal_x 0.6" "$seen" "intensity 1 x 100; intensity 0.6 normal_x 0"
