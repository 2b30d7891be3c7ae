#!/usr/bin/env bash
# Open3D: a PLY written as text has six digits, under a header that says double: a UTM northing comes back metres away,
# where the binary PLY keeps it. Needs python3.
source "$(dirname "$0")/install.sh"
debian_with_dependencies python3-open3d=0.16.1+ds-2+b4
seen=$(cd "$tmp" && python3 - <<'PY'
import numpy
import open3d
cloud = open3d.geometry.PointCloud()
cloud.points = open3d.utility.Vector3dVector([(686121.757, 5330438.125, 512.345)])
def there_and_back(name, text):
    open3d.io.write_point_cloud(name, cloud, write_ascii=text)
    return " ".join("%.3f" % value for value in numpy.asarray(open3d.io.read_point_cloud(name).points)[0])
print("binary PLY", there_and_back("a.ply", False) + "; PLY as text", there_and_back("a.ply", True))
PY
)
report "Open3D 0.16.1" "binary PLY 686121.757 5330438.125 512.345; PLY as text the same" "$seen" \
  "binary PLY 686121.757 5330438.125 512.345; PLY as text 686122.000 5330440.000 512.345"
