#!/usr/bin/env bash
# OpenCV: polarToCart with its optional radius left out is right for float and wrong for double: the cosine of 0.1
# comes out as 0.007. Needs g++.
source "$(dirname "$0")/install.sh"
debian_with_dependencies libopencv-core-dev=4.6.0+dfsg-12 libopencv-core406=4.6.0+dfsg-12
cxx -I "$root/usr/include/opencv4" -lopencv_core <<'CXX'
#include <opencv2/core.hpp>
#include <cstdio>
int main() {
  const cv::Mat angle = (cv::Mat_<double>(1, 4) << 0.1, 0.2, 0.3, 0.4), one = cv::Mat::ones(1, 4, CV_64F);
  cv::Mat floats, x, y, with_radius, as_float;
  angle.convertTo(floats, CV_32F);
  cv::polarToCart(one, angle, with_radius, y);
  cv::polarToCart(cv::noArray(), floats, as_float, y);
  cv::polarToCart(cv::noArray(), angle, x, y);
  std::printf("%.4f with a radius of 1, %.4f as float, %.4f as double", with_radius.at<double>(0),
              as_float.at<float>(0), x.at<double>(0));
}
CXX
report "OpenCV 4.6.0, x of the first of the angles 0.1, 0.2, 0.3, 0.4" \
  "0.9950 with a radius of 1, 0.9950 as float, 0.9950 as double" "$("$tmp/probe")" \
  "0.9950 with a radius of 1, 0.9950 as float, 0.0[0-9]* as double"
