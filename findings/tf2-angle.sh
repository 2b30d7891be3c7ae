#!/usr/bin/env bash
# tf2: the angle of the rotation between two headings that lie on either side of south is almost a full turn, where
# Eigen says 0.08; and Eigen's own Euler angles of a turn of -0.1 about z have a yaw of 3.04. Needs g++.
source "$(dirname "$0")/install.sh"
debian libtf2-dev=0.7.6-1+b2 libroscpp-core-dev=0.7.2-8+b2 libeigen3-dev=3.4.0-4
cxx <<'CXX'
#include <Eigen/Geometry>
#include <tf2/LinearMath/Matrix3x3.h>
#include <tf2/LinearMath/Quaternion.h>
#include <cstdio>
int main() {
  tf2::Quaternion first, second, small;
  first.setRPY(0, 0, 3.1);
  second.setRPY(0, 0, -3.1);
  const tf2::Quaternion error = first.inverse() * second;
  const double by_eigen = Eigen::AngleAxisd(Eigen::Quaterniond(error.w(), error.x(), error.y(), error.z())).angle();
  small.setRPY(0, 0, -0.1);
  double roll, pitch, yaw;
  tf2::Matrix3x3(small).getRPY(roll, pitch, yaw);
  const Eigen::Matrix3d matrix = Eigen::AngleAxisd(-0.1, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  std::printf("angle %.2f (tf2) %.2f (Eigen); yaw %.2f (tf2) %.2f (Eigen)", error.getAngle(), by_eigen, yaw,
              matrix.eulerAngles(2, 1, 0)[0]);
}
CXX
report "tf2 0.7.6, Eigen 3.4.0: from yaw 3.1 to yaw -3.1, and a yaw of -0.1" \
  "angle 0.08 (tf2) 0.08 (Eigen); yaw -0.10 (tf2) -0.10 (Eigen)" "$("$tmp/probe")" \
  "angle 6.20 \(tf2\) 0.08 \(Eigen\); yaw -0.10 \(tf2\) 3.04 \(Eigen\)"
