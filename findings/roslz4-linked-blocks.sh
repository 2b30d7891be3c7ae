#!/usr/bin/env bash
# python3-roslz4, which unpacks the lz4 chunks of ROS 1 bags: a frame whose blocks refer to the ones before, as the lz4
# library makes unless told otherwise, is "malformed data". Needs python3.
source "$(dirname "$0")/install.sh"
debian_with_dependencies python3-roslz4=1.15.15+ds-2 lz4=1.9.4-1
seen=$(cd "$tmp" && python3 - <<'PY'
import subprocess
import roslz4
points = b"".join((k % 977).to_bytes(4, "little") for k in range(200000))  # several blocks of 64 kB
def unpacked(blocks):
    frame = subprocess.run(["lz4", "-c", "-B4", blocks], input=points, capture_output=True, check=True).stdout
    again = subprocess.run(["lz4", "-dc"], input=frame, capture_output=True, check=True).stdout
    assert again == points
    try:
        return "unpacked" if roslz4.decompress(frame) == points else "other bytes"
    except OSError as error:
        return str(error)
print(f"independent blocks: {unpacked('-BI')}; linked blocks: {unpacked('-BD')}")
PY
)
report "python3-roslz4 1.15.15, lz4 1.9.4" "independent blocks: unpacked; linked blocks: unpacked" "$seen" \
  "independent blocks: unpacked; linked blocks: malformed data to decompress"
