#!/usr/bin/env bash
# npm's geotiff: heights of an Int16Array or Int32Array are cut to their low bytes, packed into the first half or
# quarter of the raster, under a header that is right; of an ordinary array, whole metres modulo 256 remain.
# Float32Array and Uint16Array are written as they are. Needs node and npm.
source "$(dirname "$0")/install.sh"
debian_with_dependencies gdal-bin=3.6.2+dfsg-1+b2 libgdal32=3.6.2+dfsg-1+b2 gdal-data=3.6.2+dfsg-1 proj-data=9.1.1-1
export GDAL_DATA=$root/usr/share/gdal PROJ_DATA=$root/usr/share/proj
npm_packages geotiff@3.0.5
cd "$tmp"
cat >a.mjs <<'JS'
import { writeFileSync } from 'fs';
import { writeArrayBuffer } from 'geotiff';
const heights = [500, 501, -12, 503];
for (const [name, values] of Object.entries({
  Float32Array: Float32Array.from(heights), Int16Array: Int16Array.from(heights), Array: [500.5, 501, 12, 503],
})) {
  const where = { ProjectedCSTypeGeoKey: 32632, ModelPixelScale: [10, 10, 0],
    ModelTiepoint: [0, 0, 0, 500000, 5330000, 0] };
  const file = await writeArrayBuffer(values, { width: 2, height: 2, ...where });
  writeFileSync(`${name}.tif`, Buffer.from(file));
}
JS
node a.mjs
heights() { gdal_translate -q -of XYZ "$1.tif" /vsistdout/ | awk '{ printf " %s", $3 }'; }
report "geotiff 3.0.5, read by GDAL 3.6.2" \
  "Float32Array 500 501 -12 503; Int16Array 500 501 -12 503; Array 500.5 501 12 503" \
  "Float32Array$(heights Float32Array); Int16Array$(heights Int16Array); Array$(heights Array)" \
  "Float32Array 500 501 -12 503; Int16Array -2827 -2825 0 0; Array 244 245 12 247"
