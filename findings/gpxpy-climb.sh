#!/usr/bin/env bash
# gpxpy: heights are smoothed before climbs are added up, so hills of 10 m every 200 m are counted at a fifth; and
# lengths take every degree of latitude for 111.3 km, 0.7 % too much at the equator. Needs python3.
source "$(dirname "$0")/install.sh"
debian_with_dependencies python3-gpxpy=1.5.0-1
seen=$(python3 - <<'PY'
import gpxpy.geo
from gpxpy.gpx import GPXTrackPoint, GPXTrackSegment
track = GPXTrackSegment([GPXTrackPoint(0.0009 * k, 0, elevation=10 * (k % 2)) for k in range(101)])
length = gpxpy.geo.distance(0, 0, None, 0.009043695, 0, None) # 1000.0 m on the WGS 84 ellipsoid
print("climb %.0f m, length %.1f m" % (track.get_uphill_downhill().uphill, length))
PY
)
report "gpxpy 1.5.0, 50 hills of 10 m, and 1000.0 m north from the equator" "climb 500 m, length 1000.0 m" "$seen" \
  "climb 10. m, length 1006\.. m"
