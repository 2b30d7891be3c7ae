#!/usr/bin/env bash
# Open3D: every colour of a PLY is divided by 255, whatever its type: white is 1 from bytes, 257 from 16-bit numbers and
# nearly black (0.004) from floats. Needs python3.
source "$(dirname "$0")/install.sh"
debian_with_dependencies python3-open3d=0.16.1+ds-2+b4
seen=$(cd "$tmp" && python3 - <<'PY'
import open3d
def white(kind, value):
    names = "".join("property float %s\n" % n for n in "xyz") + \
            "".join("property %s %s\n" % (kind, n) for n in ("red", "green", "blue"))
    with open("a.ply", "w") as file:
        file.write("ply\nformat ascii 1.0\nelement vertex 1\n" + names + "end_header\n1 2 3" + 3 * (" " + value) + "\n")
    return "%s %.3f" % (kind, open3d.io.read_point_cloud("a.ply").colors[0][0])
print(white("uchar", "255"), white("ushort", "65535"), white("float", "1.0"), sep=", ")
PY
)
report "Open3D 0.16.1, white in a PLY" "uchar 1.000, ushort 1.000, float 1.000" "$seen" \
  "uchar 1.000, ushort 257.000, float 0.004"
