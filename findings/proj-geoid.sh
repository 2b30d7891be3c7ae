#!/usr/bin/env bash
# PROJ: from the ellipsoid to heights over EGM96 a height changes by 46 m; to EGM2008, whose grid Debian does not ship,
# it does not change at all, and cs2cs ends with 0 and says nothing.
source "$(dirname "$0")/install.sh"
debian_with_dependencies proj-bin=9.1.1-1+b1 libproj25=9.1.1-1+b1 proj-data=9.1.1-1
export PROJ_DATA=$root/usr/share/proj PROJ_NETWORK=OFF
height() { echo "48.1 11.5 600" | cs2cs -f %.1f EPSG:4979 "$1" 2>&1 | awk '{ print $3 }'; }
report "PROJ 9.1.1, 600 m over the ellipsoid at 48.1 N 11.5 E" "EGM96 554.4, EGM2008 about 554 or an error" \
  "EGM96 $(height EPSG:4326+5773), EGM2008 $(height EPSG:4326+3855)" "EGM96 554.4, EGM2008 600.0"
