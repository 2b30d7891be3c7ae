#!/usr/bin/env bash
# MRPT: CPointsMapXYZI writes KITTI's .bin always compressed and reads it compressed only if its name ends in .gz, so
# that what it wrote as scan.bin comes back, without an error, as other points. Needs g++.
source "$(dirname "$0")/install.sh"
debian_with_dependencies libmrpt-maps-dev=1:2.5.8+ds-2 libmrpt-maps2.5=1:2.5.8+ds-2 libeigen3-dev=3.4.0-4
cd "$tmp"
cxx $(printf -- '-I%s ' {"$root",}/usr/include/mrpt/*/include) -lmrpt-maps -lmrpt-obs -lmrpt-opengl -lmrpt-poses \
  -lmrpt-math -lmrpt-io -lmrpt-serialization -lmrpt-rtti -lmrpt-system -lmrpt-core <<'CXX'
#include <mrpt/maps/CPointsMapXYZI.h>
#include <cstdio>
int main() {
  for (const char* name : {"scan.bin.gz", "scan.bin"}) {
    mrpt::maps::CPointsMapXYZI scan, read;
    for (int i = 0; i < 10000; ++i) scan.insertPointFast(i * 0.01f, 1, 2);
    scan.mark_as_modified();
    const bool saved = scan.saveToKittiVelodyneFile(name), loaded = read.loadFromKittiVelodyneFile(name);
    bool same = read.size() == scan.size();
    for (std::size_t i = 0; same && i < scan.size(); ++i)
      same = scan.getPointsBufferRef_x()[i] == read.getPointsBufferRef_x()[i];
    std::printf("%s %s, %s, %s; ", name, saved ? "saved" : "not saved", loaded ? "loaded" : "not loaded",
                same ? "the same" : "other points");
  }
}
CXX
report "MRPT 2.5.8" "scan.bin.gz saved, loaded, the same; scan.bin saved, loaded, the same; " "$("$tmp/probe")" \
  "scan.bin.gz saved, loaded, the same; scan.bin saved, loaded, other points; "
