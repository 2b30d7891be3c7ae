#!/usr/bin/env bash
# ROS 1's tf2 for Python: a transform of a PointCloud2 moves its first three fields, whatever their names, so that of
# points with the time first it is the time that moves; and it leaves normals as they were. Needs python3.
source "$(dirname "$0")/install.sh"
debian_with_dependencies python3-tf2-sensor-msgs=0.7.6-1 python3-sensor-msgs=1.13.1-1
seen=$(cd "$tmp" && python3 - <<'PY'
from geometry_msgs.msg import TransformStamped
from sensor_msgs import point_cloud2
from sensor_msgs.msg import PointField
from std_msgs.msg import Header
from tf2_sensor_msgs.tf2_sensor_msgs import do_transform_cloud
def moved(names, point, transform):
    fields = [PointField(name, 4 * i, PointField.FLOAT32, 1) for i, name in enumerate(names)]
    cloud = do_transform_cloud(point_cloud2.create_cloud(Header(), fields, [point]), transform)
    return " ".join("%s %.1f" % pair for pair in zip(names, next(point_cloud2.read_points(cloud))))
shift, turn = TransformStamped(), TransformStamped()
shift.transform.translation.x = 10
shift.transform.rotation.w = 1
turn.transform.rotation.z = turn.transform.rotation.w = 0.5 ** 0.5
print(moved(("t", "x", "y", "z"), (0.1, 1, 2, 3), shift) + ";",
      moved(("x", "y", "z", "normal_x", "normal_y", "normal_z"), (1, 0, 0, 1, 0, 0), turn))
PY
)
report "python3-tf2-sensor-msgs 0.7.6, x + 10 m; a quarter turn about z" \
  "t 0.1 x 11.0 y 2.0 z 3.0; x 0.0 y 1.0 z 0.0 normal_x 0.0 normal_y 1.0 normal_z 0.0" "$seen" \
  "t 10.1 x 1.0 y 2.0 z 3.0; x 0.0 y 1.0 z 0.0 normal_x 1.0 normal_y 0.0 normal_z 0.0"
