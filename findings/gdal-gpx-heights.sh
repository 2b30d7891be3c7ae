#!/usr/bin/env bash
# GDAL: a 3-D point written as GPX loses its height, a 3-D line keeps it; reading that line back gives a flat one.
source "$(dirname "$0")/install.sh"
debian_with_dependencies gdal-bin=3.6.2+dfsg-1+b2 libgdal32=3.6.2+dfsg-1+b2 gdal-data=3.6.2+dfsg-1 proj-data=9.1.1-1
export GDAL_DATA=$root/usr/share/gdal PROJ_DATA=$root/usr/share/proj
cd "$tmp"
feature() { # TYPE COORDINATES
  echo "{\"type\":\"Feature\",\"properties\":{},\"geometry\":{\"type\":\"$1\",\"coordinates\":$2}}"
}
feature Point '[11.5,48.1,512.25]' >point.geojson
feature LineString '[[11.5,48.1,512.25],[11.6,48.1,513.25]]' >line.geojson
ogr2ogr -f GPX point.gpx point.geojson
ogr2ogr -f GPX line.gpx line.geojson
written() { grep -c '<ele>' "$1" || true; }
back=$(ogrinfo -al line.gpx routes | grep -oE 'LINESTRING( Z)?')
report "GDAL 3.6.2" "heights written: point 1, line 2; line read back as LINESTRING Z" \
  "heights written: point $(written point.gpx), line $(written line.gpx); line read back as $back" \
  "heights written: point 0, line 2; line read back as LINESTRING"
