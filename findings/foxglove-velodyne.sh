#!/usr/bin/env bash
# @foxglove/velodyne-cloud: a VLP-16's second firing of a block, 55 microseconds after the first, gets the azimuth of
# the first; the angle turned through in between is calculated but not used. At 20 Hz that is 0.4 degrees, at 50 m a
# shift of 0.35 m of every second column. The times are right. Needs node and npm.
source "$(dirname "$0")/install.sh"
npm_packages @foxglove/velodyne-cloud@1.0.1
cat >"$tmp/a.mjs" <<'JS'
import { Calibration, PointCloud, RawPacket, Transformer } from '@foxglove/velodyne-cloud';
const packet = new DataView(new ArrayBuffer(1206)); // of a sensor at 20 Hz, everything 50 m away
for (let block = 0; block < 12; ++block) {
  packet.setUint16(100 * block, 0xeeff, true);
  packet.setUint16(100 * block + 2, 9000 + 80 * block, true);
  for (let i = 0; i < 32; ++i) packet.setUint16(100 * block + 4 + 3 * i, 25000, true);
}
packet.setUint16(1204, 0x2237, true); // strongest return, VLP-16
const raw = new RawPacket(new Uint8Array(packet.buffer));
const cloud = new PointCloud({ stamp: raw.timestamp(), maxPoints: 384 });
new Transformer(new Calibration(raw.inferModel())).unpack(raw, raw.timestamp(), undefined, cloud);
const data = new DataView(cloud.data.buffer, cloud.data.byteOffset);
const seen = [0, 16, 32].map((i) => { // laser 0
  const at = i * cloud.point_step;
  const azimuth = -Math.atan2(data.getFloat32(at + 4, true), data.getFloat32(at, true)) * 180 / Math.PI;
  return `${azimuth.toFixed(1)} at ${(data.getUint32(at + 24, true) / 1000).toFixed(0)} us`;
});
console.log(seen.join(', '));
JS
report "@foxglove/velodyne-cloud 1.0.1, azimuth of three firings of a VLP-16's laser" \
  "90.0 at 0 us, 90.4 at 55 us, 90.8 at 111 us" "$(node "$tmp/a.mjs")" "90.0 at 0 us, 90.0 at 55 us, 90.8 at 111 us"
