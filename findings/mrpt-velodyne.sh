#!/usr/bin/env bash
# MRPT: the cloud made from a VLP-16's packets has the first of the two firings of each block alone, which is half of
# the returns, and one time for all points of a packet, which spans 1.3 ms. Needs g++.
source "$(dirname "$0")/install.sh"
debian_with_dependencies libmrpt-obs-dev=1:2.5.8+ds-2 libmrpt-obs2.5=1:2.5.8+ds-2 libeigen3-dev=3.4.0-4
cxx $(printf -- '-I%s ' {"$root",}/usr/include/mrpt/*/include) -lmrpt-obs -lmrpt-poses -lmrpt-math -lmrpt-io \
  -lmrpt-serialization -lmrpt-rtti -lmrpt-system -lmrpt-core <<'CXX'
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <cstdio>
#include <cstring>
#include <set>
int main() {
  using Scan = mrpt::obs::CObservationVelodyneScan;
  Scan scan;
  scan.calibration = mrpt::obs::VelodyneCalibration::LoadDefaultCalibration("VLP16");
  constexpr int kPackets = 76; // about one turn at 10 Hz
  for (int packet = 0; packet < kPackets; ++packet) {
    unsigned char bytes[1206] = {};
    for (int block = 0; block < 12; ++block) { // two firings of 16 lasers, 10 m in every direction
      unsigned char* at = bytes + 100 * block;
      const int azimuth = (packet * 12 + block) * 39 % 36000, distance = 5000;
      at[0] = 0xff;
      at[1] = 0xee;
      at[2] = azimuth & 255;
      at[3] = azimuth >> 8;
      for (int i = 0; i < 32; ++i) {
        at[4 + 3 * i] = distance & 255;
        at[5 + 3 * i] = distance >> 8;
        at[6 + 3 * i] = 100;
      }
    }
    const unsigned microseconds = packet * 1327;
    std::memcpy(bytes + 1200, &microseconds, 4);
    bytes[1204] = 0x37; // strongest return
    bytes[1205] = 0x22; // VLP-16
    Scan::TVelodyneRawPacket raw;
    std::memcpy(&raw, bytes, sizeof raw);
    scan.scan_packets.push_back(raw);
  }
  Scan::TGeneratePointCloudParameters wanted;
  wanted.generatePerPointTimestamp = true;
  scan.generatePointCloud(wanted);
  const std::set<mrpt::Clock::time_point> times(scan.point_cloud.timestamp.begin(), scan.point_cloud.timestamp.end());
  std::printf("%zu points with %zu times of %d returns in %d firings", scan.point_cloud.size(), times.size(),
              kPackets * 12 * 32, kPackets * 24);
}
CXX
report "MRPT 2.5.8" "29184 points with 1824 times of 29184 returns in 1824 firings" "$("$tmp/probe")" \
  "14592 points with 76 times of 29184 returns in 1824 firings"
