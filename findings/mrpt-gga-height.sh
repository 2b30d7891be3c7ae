#!/usr/bin/env bash
# MRPT: the geodetic coordinates of a GGA message have the height over the geoid, without the separation that stands in
# the same message. All of MRPT's conversions take that number for the height over the ellipsoid. Needs g++.
source "$(dirname "$0")/install.sh"
debian_with_dependencies libmrpt-topography-dev=1:2.5.8+ds-2 libmrpt-topography2.5=1:2.5.8+ds-2 \
  libmrpt-obs-dev=1:2.5.8+ds-2 libmrpt-obs2.5=1:2.5.8+ds-2
cxx $(printf -- '-I%s ' {"$root",}/usr/include/mrpt/*/include) -I /usr/include/eigen3 -lmrpt-topography -lmrpt-obs \
  -lmrpt-poses -lmrpt-math -lmrpt-io -lmrpt-serialization -lmrpt-rtti -lmrpt-system -lmrpt-core <<'CXX'
#include <mrpt/obs/gnss_messages_ascii_nmea.h>
#include <mrpt/topography/conversions.h>
#include <cmath>
#include <cstdio>
int main() {
  mrpt::obs::gnss::Message_NMEA_GGA gga;
  gga.fields.latitude_degrees = 48.1;
  gga.fields.longitude_degrees = 11.5;
  gga.fields.altitude_meters = 512.0;
  gga.fields.geoidal_distance = 46.9;
  const auto place = gga.getAsStruct<mrpt::topography::TGeodeticCoords>();
  mrpt::math::TPoint3D ecef, surface;
  mrpt::topography::geodeticToGeocentric_WGS84(place, ecef);
  auto foot = place;
  foot.height = 0;
  mrpt::topography::geodeticToGeocentric_WGS84(foot, surface);
  std::printf("height %.1f m, %.1f m over the ellipsoid", place.height, (ecef - surface).norm());
}
CXX
report "MRPT 2.5.8, GGA with altitude 512.0 m and geoid separation 46.9 m" \
  "height 558.9 m, 558.9 m over the ellipsoid" "$("$tmp/probe")" "height 512.0 m, 512.0 m over the ellipsoid"
