#!/usr/bin/env bash
# A GeoTIFF whose cells are points (usual for heights), written by GDAL and read by npm's geotiff: the bounding box is
# off by half a cell in both directions, since the corner that the file names is taken for the cell's edge. Needs node
# and npm.
source "$(dirname "$0")/install.sh"
debian_with_dependencies gdal-bin=3.6.2+dfsg-1+b2 libgdal32=3.6.2+dfsg-1+b2 gdal-data=3.6.2+dfsg-1 proj-data=9.1.1-1
export GDAL_DATA=$root/usr/share/gdal PROJ_DATA=$root/usr/share/proj
npm_packages geotiff@3.0.5
cd "$tmp"
printf 'ncols 2\nnrows 2\nxllcorner 500000\nyllcorner 5300000\ncellsize 10\n1.5 2.5\n3.5 4.5\n' >heights.asc
gdal_translate -q -a_srs EPSG:32632 heights.asc Area.tif
gdal_translate -q -a_srs EPSG:32632 -mo AREA_OR_POINT=Point heights.asc Point.tif
cat >a.mjs <<'JS'
import { fromFile } from 'geotiff';
for (const kind of ['Area', 'Point']) {
  const box = (await (await fromFile(`${kind}.tif`)).getImage()).getBoundingBox();
  process.stdout.write(` ${kind} ${box[0]} ${box[3]}`);
}
process.exit(0);
JS
corner() { gdalinfo "$1.tif" | sed -nE 's/^Origin = \(([0-9]+)[.0-9]*,([0-9]+).*/\1 \2/p'; }
report "GDAL 3.6.2, geotiff 3.0.5, upper left corner" \
  "GDAL: Area $(corner Area) Point $(corner Point); geotiff: Area 500000 5300020 Point 500000 5300020" \
  "GDAL: Area $(corner Area) Point $(corner Point); geotiff:$(node a.mjs)" \
  "GDAL: Area 500000 5300020 Point 500000 5300020; geotiff: Area 500000 5300020 Point 500005 5300015"
