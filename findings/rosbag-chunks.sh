#!/usr/bin/env bash
# python3-rosbag: read_messages yields the same messages of one topic in time order when they are in one chunk, and in
# another order when the bag has smaller chunks, if they were not written in time order. Needs python3.
source "$(dirname "$0")/install.sh"
debian_with_dependencies python3-rosbag=1.15.15+ds-2 python3-std-msgs=0.5.13-2
seen=$(cd "$tmp" && python3 - <<'PY'
import genpy, rosbag
from std_msgs.msg import Int32
def order(chunk_bytes):
    with rosbag.Bag("a.bag", "w", chunk_threshold=chunk_bytes) as bag:
        for second in (0, 5, 1, 6, 2, 7, 3, 8, 4):
            bag.write("/a", Int32(second), genpy.Time(1000 + second))
    with rosbag.Bag("a.bag") as bag:
        return "".join(str(message.data) for _, message, _ in bag.read_messages())
print("one chunk:", order(1 << 20) + "; five chunks:", order(64))
PY
)
report "python3-rosbag 1.15.15" "one chunk: 012345678; five chunks: 012345678" "$seen" \
  "one chunk: 012345678; five chunks: 015263748"
