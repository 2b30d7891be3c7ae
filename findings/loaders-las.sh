#!/usr/bin/env bash
# @loaders.gl/las: colours, which LAS stores with 16 bits, are cut to their low byte unless an option says otherwise: a
# white of 65280 (255 * 256) becomes black, half of it too. Needs node and npm.
source "$(dirname "$0")/install.sh"
npm_packages @loaders.gl/core@4.4.5 @loaders.gl/las@4.4.5
cat >"$tmp/a.mjs" <<'JS'
import { parse } from '@loaders.gl/core';
import { LASLoader } from '@loaders.gl/las';
const file = new DataView(new ArrayBuffer(227 + 34)); // LAS 1.2, one point of format 3
[...'LASF'].forEach((letter, i) => file.setUint8(i, letter.charCodeAt(0)));
file.setUint8(24, 1);
file.setUint8(25, 2);
file.setUint16(94, 227, true);
file.setUint32(96, 227, true);
file.setUint8(104, 3);
file.setUint16(105, 34, true);
file.setUint32(107, 1, true);
for (let axis = 0; axis < 3; ++axis) file.setFloat64(131 + 8 * axis, 0.001, true);
[65280, 32768, 40000].forEach((value, i) => file.setUint16(227 + 28 + 2 * i, value, true));
const { attributes } = await parse(file.buffer, LASLoader, { worker: false });
console.log([...attributes.COLOR_0.value].slice(0, 3).join(' '));
JS
report "@loaders.gl/las 4.4.5, a point with the colour 65280 32768 40000" "255 128 156" "$(node "$tmp/a.mjs")" "0 0 64"
