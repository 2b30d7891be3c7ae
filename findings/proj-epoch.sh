#!/usr/bin/env bash
# PROJ: ITRF2014 to ETRS89 without a fourth coordinate is not refused: the plates' motion is left out, 0.4 m in 2026.
# From WGS 84, which is ITRF to some centimetres, nothing is moved at all, where it should be 0.9 m.
source "$(dirname "$0")/install.sh"
debian_with_dependencies proj-bin=9.1.1-1+b1 libproj25=9.1.1-1+b1 proj-data=9.1.1-1
export PROJ_DATA=$root/usr/share/proj PROJ_NETWORK=OFF
moved() { # metres from 48.1 N 11.5 E, by the CRS that it is given in
  echo "$2" | cs2cs -f %.9f "$1" EPSG:4937 2>&1 |
    awk '{ printf "%.1f", sqrt((($1 - 48.1) * 111200) ^ 2 + (($2 - 11.5) * 74500) ^ 2) }'
}
report "PROJ 9.1.1, shift of a place in Europe to ETRS89" \
  "ITRF2014 in 2026 0.9 m, without a year 0.9 m or an error, WGS 84 0.9 m" \
  "ITRF2014 in 2026 $(moved EPSG:7912 '48.1 11.5 600 2026') m, without a year $(
    moved EPSG:7912 '48.1 11.5 600') m, WGS 84 $(moved EPSG:4979 '48.1 11.5 600') m" \
  "ITRF2014 in 2026 0.9 m, without a year 0.5 m, WGS 84 0.0 m"
