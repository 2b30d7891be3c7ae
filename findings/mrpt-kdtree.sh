#!/usr/bin/env bash
# MRPT: a 2-D query of a map that was asked in 3-D before throws that there are no points. Needs g++.
source "$(dirname "$0")/install.sh"
debian_with_dependencies libmrpt-maps-dev=1:2.5.8+ds-2 libmrpt-maps2.5=1:2.5.8+ds-2 libeigen3-dev=3.4.0-4
cxx $(printf -- '-I%s ' {"$root",}/usr/include/mrpt/*/include) -lmrpt-maps -lmrpt-obs -lmrpt-opengl -lmrpt-poses \
  -lmrpt-math -lmrpt-io -lmrpt-serialization -lmrpt-rtti -lmrpt-system -lmrpt-core <<'CXX'
#include <mrpt/maps/CSimplePointsMap.h>
#include <cstdio>
#include <string>
int main() {
  for (const bool solid_first : {false, true}) {
    mrpt::maps::CSimplePointsMap map;
    for (int i = 0; i < 100; ++i) map.insertPoint(i, 0, 0);
    float x, y, z, squared;
    if (solid_first) map.kdTreeClosestPoint3D(5.2f, 0, 0, x, y, z, squared);
    std::string answer;
    try {
      answer = std::to_string(map.kdTreeClosestPoint2D(5.2f, 0, x, y, squared));
    } catch (const std::exception& e) {
      answer = std::string(e.what()).find("no points") != std::string::npos ? "there are no points" : "another error";
    }
    std::printf("%s: %s; ", solid_first ? "after 3-D" : "2-D alone", answer.c_str());
  }
}
CXX
report "MRPT 2.5.8, nearest of 100 points" "2-D alone: 5; after 3-D: 5; " "$("$tmp/probe")" \
  "2-D alone: 5; after 3-D: there are no points; "
