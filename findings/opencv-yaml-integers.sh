#!/usr/bin/env bash
# OpenCV: a whole number of YAML or JSON beyond 32 bits is cut to its low 32 bits, with a new sign, even where the
# program asks for a double: nanoseconds since 1970 come out as some other number. Needs g++.
source "$(dirname "$0")/install.sh"
debian_with_dependencies libopencv-core-dev=4.6.0+dfsg-12 libopencv-core406=4.6.0+dfsg-12
cxx -I "$root/usr/include/opencv4" -lopencv_core <<'CXX'
#include <opencv2/core.hpp>
#include <cstdio>
int main() {
  const auto read = [](const char* text) {
    const cv::FileStorage file(text, cv::FileStorage::READ | cv::FileStorage::MEMORY);
    return double(file["start"]);
  };
  std::printf("YAML %.0f, with a point %.0f, JSON %.0f; 3000000000 %.0f",
              read("%YAML:1.0\n---\nstart: 1403636579763555584\n"),
              read("%YAML:1.0\n---\nstart: 1403636579763555584.\n"), read("{\"start\": 1403636579763555584}"),
              read("%YAML:1.0\n---\nstart: 3000000000\n"));
}
CXX
report "OpenCV 4.6.0, 1403636579763555584 asked for as double" \
  "YAML 1403636579763555584, with a point 1403636579763555584, JSON 1403636579763555584; 3000000000 3000000000" \
  "$("$tmp/probe")" \
  "YAML 1384975616, with a point 1403636579763555584, JSON 1384975616; 3000000000 -1294967296"
