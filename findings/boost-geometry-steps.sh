#!/usr/bin/env bash
# Boost.Geometry: the distance of two geographic points is 0 or 0.1 m when they are closer than that, and wrong by per
# cents up to half a metre, unless one is due north of the other: the formula that it takes for the ellipsoid ends
# in the arc cosine of almost 1. A walk to the east at 10 Hz has no length. Needs g++.
source "$(dirname "$0")/install.sh"
debian libboost1.74-dev=1.74.0+ds1-21
cxx -DBOOST_ALLOW_DEPRECATED_HEADERS <<'CXX'
#include <boost/geometry.hpp>
#include <boost/geometry/strategies/geographic/distance_vincenty.hpp>
#include <cstdio>
namespace bg = boost::geometry;
using Place = bg::model::point<double, 2, bg::cs::geographic<bg::degree>>;
void print(const char* name, double east, double north) {
  bg::model::linestring<Place> track;
  for (int i = 0; i <= 1000; ++i) track.push_back({11.5 + i * east / 74502, 48.1 + i * north / 111202});
  const double length = bg::length(track), by_vincenty = bg::length(track, bg::strategy::distance::vincenty<>());
  std::printf("%s %.0f (%.0f)", name, length, by_vincenty);
}
int main() {
  print("0.1 m to the north", 0, 0.1);
  print("; to the east", 0.1, 0);
  print("; 0.2 m to the east", 0.2, 0);
  print("; 0.05 m to the north-east", 0.03, 0.04);
}
CXX
report "Boost 1.74.0, length of 1000 steps, in brackets by Vincenty's formula" \
  "0.1 m to the north 100 (100); to the east 100 (100); 0.2 m to the east 200 (200); 0.05 m to the north-east 50 (50)" \
  "$("$tmp/probe")" \
  "0.1 m to the north 100 .100.; to the east 0 .100.; 0.2 m to the east 190 .200.; 0.05 m to the north-east 1[0-9] .50."
