#!/usr/bin/env bash
# @foxglove/rosbag: of a bag whose chunks overlap in time, endTime is the last chunk's, before the last message; and
# the package's two ways to read give two orders. Needs node, npm and python3 (the bag is made with python3-rosbag).
source "$(dirname "$0")/install.sh"
debian_with_dependencies python3-rosbag=1.15.15+ds-2 python3-std-msgs=0.5.13-2
npm_packages @foxglove/rosbag@0.4.1 tslib@2.8.1
cd "$tmp"
python3 - <<'PY'
import genpy, rosbag
from std_msgs.msg import Int32
with rosbag.Bag("a.bag", "w", chunk_threshold=1) as bag:
    for second in (0, 2, 1, 4, 3):
        bag.write("/a", Int32(second), genpy.Time(1000 + second))
PY
cat >a.cjs <<'JS'
const { Bag } = require('@foxglove/rosbag');
const { FileReader } = require('@foxglove/rosbag/node');
(async () => {
  const bag = new Bag(new FileReader('a.bag'), { parse: false });
  await bag.open();
  const iterated = [], read = [];
  for await (const message of bag.messageIterator()) iterated.push(message.timestamp.sec - 1000);
  await bag.readMessages({}, (message) => read.push(message.timestamp.sec - 1000));
  console.log(`ends at ${bag.endTime.sec}; messageIterator ${iterated.join('')}, readMessages ${read.join('')}`);
})();
JS
report "@foxglove/rosbag 0.4.1" "ends at 1004; messageIterator 01234, readMessages 01234" \
  "$(node --no-warnings a.cjs)" "ends at 1003; messageIterator 01234, readMessages 02143"
