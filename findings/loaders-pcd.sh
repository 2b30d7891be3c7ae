#!/usr/bin/env bash
# @loaders.gl/pcd: coordinates stored as doubles are read as zeros, red and blue change places, and a field of three
# numbers before x shifts the columns of a text file; no error or warning. Needs node and npm.
source "$(dirname "$0")/install.sh"
npm_packages @loaders.gl/core@4.4.5 @loaders.gl/pcd@4.4.2
cat >"$tmp/a.mjs" <<'JS'
import { parse } from '@loaders.gl/core';
import { PCDLoader } from '@loaders.gl/pcd';
const read = async (fields, sizes, types, counts, kind, data) => {
  const header = `# .PCD v0.7\nVERSION 0.7\nFIELDS ${fields}\nSIZE ${sizes}\nTYPE ${types}\nCOUNT ${counts}\n` +
    `WIDTH 1\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1\nDATA ${kind}\n`;
  const file = Buffer.concat([Buffer.from(header), Buffer.from(data)]);
  const bytes = file.buffer.slice(file.byteOffset, file.byteOffset + file.length);
  const { POSITION, COLOR_0 } = (await parse(bytes, PCDLoader, { worker: false })).attributes;
  return [...(fields.includes('rgb') ? COLOR_0 : POSITION).value].join(' ');
};
const doubles = new Float64Array([1.25, 2.5, 3.75]).buffer;
const coloured = new DataView(new ArrayBuffer(16));
coloured.setUint32(12, (10 << 16) | (20 << 8) | 30, true);
console.log(`doubles ${await read('x y z', '8 8 8', 'F F F', '1 1 1', 'binary', doubles)};`,
  `colour ${await read('x y z rgb', '4 4 4 4', 'F F F U', '1 1 1 1', 'binary', coloured.buffer)};`,
  `after a triple ${await read('normal x y z', '4 4 4 4', 'F F F F', '3 1 1 1', 'ascii', '7 8 9 1 2 3\n')}`);
JS
report "@loaders.gl/pcd 4.4.2" "doubles 1.25 2.5 3.75; colour 10 20 30; after a triple 1 2 3" "$(node "$tmp/a.mjs")" \
  "doubles 0 0 0; colour 30 20 10; after a triple 8 9 1"
