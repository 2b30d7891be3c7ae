#!/usr/bin/env bash
# OpenCV: cartToPolar takes doubles and gives doubles, but its angles are an approximation that is off by up to a
# hundredth of a degree: 1.7 cm at 100 m. Needs g++.
source "$(dirname "$0")/install.sh"
debian_with_dependencies libopencv-core-dev=4.6.0+dfsg-12 libopencv-core406=4.6.0+dfsg-12
cxx -I "$root/usr/include/opencv4" -lopencv_core <<'CXX'
#include <opencv2/core.hpp>
#include <cmath>
#include <cstdio>
int main() {
  constexpr int kCount = 36000;
  cv::Mat x(1, kCount, CV_64F), y(1, kCount, CV_64F), radius, angle;
  for (int i = 0; i < kCount; ++i) {
    x.at<double>(i) = std::cos(i * 2 * CV_PI / kCount);
    y.at<double>(i) = std::sin(i * 2 * CV_PI / kCount);
  }
  cv::cartToPolar(x, y, radius, angle);
  double worst = 0;
  for (int i = 0; i < kCount; ++i)
    worst = std::max(worst, std::abs(std::remainder(angle.at<double>(i) - i * 2 * CV_PI / kCount, 2 * CV_PI)));
  std::printf("%.1e rad", worst);
}
CXX
report "OpenCV 4.6.0, largest error of the angles of doubles" "about 1e-15 rad" "$("$tmp/probe")" "1\..e-04 rad"
