#!/usr/bin/env bash
# MRPT: GeodeticToUTM is 1 m too low in the southern hemisphere (its false northing is not 10 000 000 m) and takes no
# notice of Norway's wider zone 32. GeographicLib is right to the millimetre. Needs g++.
source "$(dirname "$0")/install.sh"
debian_with_dependencies libmrpt-topography-dev=1:2.5.8+ds-2 libmrpt-topography2.5=1:2.5.8+ds-2 \
  geographiclib-tools=2.1.2-1
cxx $(printf -- '-I%s ' {"$root",}/usr/include/mrpt/*/include) -I /usr/include/eigen3 -lmrpt-topography <<'CXX'
#include <mrpt/topography/conversions.h>
#include <cstdio>
#include <cstdlib>
int main(int, char** argument) {
  double x, y;
  int zone;
  char band;
  mrpt::topography::GeodeticToUTM(std::atof(argument[1]), std::atof(argument[2]), x, y, zone, band);
  std::printf("%d %.1f", zone, y);
}
CXX
geographiclib() { echo "$1 $2" | GeoConvert -u -p 1 | sed -E 's/^0?([0-9]+)[ns] [^ ]+ /\1 /'; }
report "MRPT 2.5.8 (GeographicLib 2.1.2 for the expected), zone and northing of Cape Town and of Bergen" \
  "$(geographiclib -33.9 18.4), $(geographiclib 60.39 5.32)" "$("$tmp/probe" -33.9 18.4), $("$tmp/probe" 60.39 5.32)" \
  "34 6245887\.1, 31 6697096\.9"
