#!/usr/bin/env bash
# Open3D: a PCD whose coordinates are doubles is read as points at the origin, without a warning; and writing PCD cuts
# them to float32, steps of half a metre in a UTM northing, where its PLY keeps them. Needs python3.
source "$(dirname "$0")/install.sh"
debian_with_dependencies python3-open3d=0.16.1+ds-2+b4
seen=$(cd "$tmp" && python3 - <<'PY'
import struct
import numpy
import open3d
def read(name):
    return " ".join("%.1f" % value for value in numpy.asarray(open3d.io.read_point_cloud(name).points)[0])
place = (500000.3, 5330438.3, 512.3)
header = "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\n" \
         "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1\nDATA binary\n"
with open("doubles.pcd", "wb") as file:
    file.write(header.encode() + struct.pack("<3d", *place))
cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector([place]))
open3d.io.write_point_cloud("own.pcd", cloud)
open3d.io.write_point_cloud("own.ply", cloud)
print("doubles in PCD %s; own PCD %s; own PLY %s" % tuple(map(read, ("doubles.pcd", "own.pcd", "own.ply"))))
PY
)
report "Open3D 0.16.1, the point 500000.3 5330438.3 512.3" \
  "doubles in PCD, own PCD and own PLY the same" "$seen" \
  "doubles in PCD 0.0 0.0 0.0; own PCD 500000.3 5330438.5 512.3; own PLY 500000.3 5330438.3 512.3"
