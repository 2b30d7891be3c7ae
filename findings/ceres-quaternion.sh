#!/usr/bin/env bash
# Ceres: the tangent of its quaternion manifolds is half a rotation vector, and in the world's axes. A step of 0.1 turns
# by 0.2 rad, so standard deviations read from its covariance are half of what they seem, about other axes. Needs g++.
source "$(dirname "$0")/install.sh"
debian libgoogle-glog-dev=0.6.0-2 libgflags-dev=2.2.2-2 libceres-dev=2.1.0+really2.1.0+dfsg-1 libeigen3-dev=3.4.0-4
debian_with_dependencies libceres3=2.1.0+really2.1.0+dfsg-1 libgoogle-glog0v6=0.6.0-2 \
  libblas3=3.11.0-2 liblapack3=3.11.0-2
cxx -lceres -lglog <<'CXX'
#include <ceres/ceres.h>
#include <cstdio>
struct Attitude { // measured to 0.1 rad about each axis
  template <class T> bool operator()(const T* q, T* residual) const {
    const Eigen::Quaternion<T> error(Eigen::Map<const Eigen::Quaternion<T>>{q});
    for (int i = 0; i < 3; ++i) residual[i] = 2.0 * error.vec()[i] / 0.1;
    return true;
  }
};
int main() {
  ceres::EigenQuaternionManifold manifold;
  const Eigen::Quaterniond start(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitX()));
  const double step[] = {0, 0, 0.1};
  Eigen::Quaterniond end;
  manifold.Plus(start.coeffs().data(), step, end.coeffs().data());
  const Eigen::AngleAxisd turn(end * start.inverse()), body(start.inverse() * end);
  const char* axes = turn.axis().z() > 0.99 ? "world's" : body.axis().z() > 0.99 ? "body's" : "?";
  std::printf("turn of %.1f rad about the %s z; ", turn.angle(), axes);
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  double* block = q.coeffs().data();
  ceres::Problem problem;
  problem.AddResidualBlock(new ceres::AutoDiffCostFunction<Attitude, 3, 4>(new Attitude), nullptr, block);
  problem.SetManifold(block, new ceres::EigenQuaternionManifold);
  ceres::Covariance covariance({});
  const std::vector<const double*> blocks = {block};
  double values[9] = {};
  if (covariance.Compute(blocks, &problem)) covariance.GetCovarianceBlockInTangentSpace(block, block, values);
  std::printf("standard deviation %.2f", std::sqrt(values[8]));
}
CXX
report "Ceres 2.1.0, EigenQuaternionManifold, step (0, 0, 0.1); attitude known to 0.10 rad" \
  "turn of 0.1 rad about the body's z; standard deviation 0.10" "$("$tmp/probe" 2>/dev/null)" \
  "turn of 0.2 rad about the world's z; standard deviation 0.05"
