#!/usr/bin/env bash
# @loaders.gl/las: a point's class is read with the flags that share its byte in formats 0 to 5, so that a withheld
# building is class 134, and colours keep their low bytes unless colorDepth is 16: LAS has them in 16 bits, and
# what a camera's 8 bits become (times 256) is black. No error or warning. Needs node and npm.
source "$(dirname "$0")/install.sh"
npm_packages @loaders.gl/core@4.3.4 @loaders.gl/las@4.3.4
cat >"$tmp/a.mjs" <<'JS'
import { parse } from '@loaders.gl/core';
import { LASLoader } from '@loaders.gl/las';
// LAS 1.2, format 2: one point of class 6 (building) whose flag "withheld" is set, its colour 255, 128, 1 of 255.
const file = Buffer.alloc(227 + 26);
file.write('LASF', 0);
file.set([1, 2], 24);
file.writeUInt16LE(227, 94);
file.writeUInt32LE(227, 96);
file[104] = 2;
file.writeUInt16LE(26, 105);
file.writeUInt32LE(1, 107);
file.writeUInt32LE(1, 111);
for (const at of [131, 139, 147]) file.writeDoubleLE(0.001, at);
const point = file.subarray(227);
[1000, 2000, 3000].forEach((value, k) => point.writeInt32LE(value, 4 * k));
point[14] = 0x11;
point[15] = 6 | 0x80;
[255, 128, 1].forEach((value, k) => point.writeUInt16LE(256 * value, 20 + 2 * k));
const bytes = file.buffer.slice(file.byteOffset, file.byteOffset + file.length);
const { POSITION, classification, COLOR_0 } = (await parse(bytes, LASLoader, { worker: false })).attributes;
console.log(`place ${[...POSITION.value]}; class ${classification.value[0]}; colour ${[...COLOR_0.value].slice(0, 3)}`);
JS
report "@loaders.gl/las 4.3.4" "place 1,2,3; class 6; colour 255,128,1" "$(node "$tmp/a.mjs")" \
  "place 1,2,3; class 134; colour 0,0,0"
