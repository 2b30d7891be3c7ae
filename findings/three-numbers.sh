#!/usr/bin/env bash
# three.js: PLYLoader turns stored colours into linear light and rounds to 8 bits again, so that 256 grey levels (class
# numbers, intensities) come out as fewer; PCDLoader cuts doubles to float32, steps of half a metre in a UTM northing,
# where PLYLoader keeps them, and reads unsigned labels as signed. Needs node and npm.
source "$(dirname "$0")/install.sh"
npm_packages three@0.187.0
cat >"$tmp/a.mjs" <<'JS'
import { PCDLoader } from 'three/examples/jsm/loaders/PCDLoader.js';
import { PLYLoader } from 'three/examples/jsm/loaders/PLYLoader.js';
const properties = (type, names) => names.map((name) => `property ${type} ${name}\n`).join('');
const ply = (types, rows) => new PLYLoader().parse(
  `ply\nformat ascii 1.0\nelement vertex ${rows.length}\n${types}end_header\n${rows.join('\n')}\n`).attributes;
const levels = [...Array(256).keys()].map((level) => `${level} 0 0 ${level} ${level} ${level}`);
const coloured = properties('float', ['x', 'y', 'z']) + properties('uchar', ['red', 'green', 'blue']);
const grey = [...ply(coloured, levels).color.array].filter((_, i) => i % 3 === 0);
const header = '# .PCD v0.7\nVERSION 0.7\nFIELDS x y z label\nSIZE 8 8 8 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 1\n' +
  'HEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1\nDATA binary\n';
const point = new DataView(new ArrayBuffer(28));
[500000.3, 5330438.3, 512.3].forEach((value, i) => point.setFloat64(8 * i, value, true));
point.setUint32(24, 4000000000, true);
const file = Buffer.concat([Buffer.from(header), Buffer.from(point.buffer)]);
const bytes = file.buffer.slice(file.byteOffset, file.byteOffset + file.length);
const pcd = new PCDLoader().parse(bytes).geometry.attributes;
const northing = ply(properties('double', ['x', 'y', 'z']), ['500000.3 5330438.3 512.3']).position.array[1];
console.log(`${new Set(grey).size} greys, 128 is ${grey[128]};`,
  `northing ${northing} (PLY) ${pcd.position.array[1]} (PCD); label ${pcd.label.array[0]}`);
JS
report "three.js 0.187.0" "256 greys, 128 is 128; northing 5330438.3 (PLY) 5330438.3 (PCD); label 4000000000" \
  "$(node "$tmp/a.mjs")" \
  "1[0-9][0-9] greys, 128 is 55; northing 5330438.3 \(PLY\) 5330438.5 \(PCD\); label -294967296"
