#include "traverse/pose_graph/factor_kinds.hpp"

#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include <ceres/autodiff_cost_function.h>

#include "pose_costs.hpp"

namespace traverse::pose_graph {

using optimization::FactorKind;
using optimization::FactorSample;
using optimization::ParameterBlock;
using optimization::Perturbation;
using optimization::RandomStates;

namespace {

template <typename T>
using Vector3 = Eigen::Matrix<T, 3, 1>;
template <typename T>
using Quaternion = Eigen::Quaternion<T>;

/// The residuals once more, written for any number type from their definitions alone, so that
/// Ceres' dual numbers can derive what residuals.cpp derives by hand.
template <typename T>
Quaternion<T> unit(const T* q) {
  return Eigen::Map<const Quaternion<T>>(q).normalized();
}

/// Away from the identity, where checks are made.
template <typename T>
Vector3<T> log_quaternion(Quaternion<T> q) {
  using std::atan2;
  if (q.w() < T(0)) q.coeffs() = -q.coeffs();
  const T sine = q.vec().norm();
  return Vector3<T>(q.vec() * (T(2) * atan2(sine, q.w()) / sine));
}

struct BetweenFunctor {
  geometry::Pose3 T_i_j;
  geometry::Matrix6 W;

  template <typename T>
  bool operator()(const T* q_i, const T* p_i, const T* q_j, const T* p_j, T* residual) const {
    const Quaternion<T> q_m = T_i_j.quaternion().template cast<T>();
    const Quaternion<T> q_map_i = unit(q_i);
    const Vector3<T> p_i_j = q_map_i.conjugate() * (Vector3<T>(p_j) - Vector3<T>(p_i));
    Eigen::Matrix<T, 6, 1> r;
    r.template head<3>() = log_quaternion<T>(q_m.conjugate() * (q_map_i.conjugate() * unit(q_j)));
    r.template tail<3>() = p_i_j - T_i_j.translation.template cast<T>();
    Eigen::Map<Eigen::Matrix<T, 6, 1>> weighted(residual);
    weighted = W.cast<T>() * r;
    return true;
  }
};

struct AntennaFunctor {
  Eigen::Vector3d antenna_map;
  Eigen::Vector3d antenna_body;
  Eigen::Matrix3d W;

  template <typename T>
  bool operator()(const T* q, const T* p, T* residual) const {
    const Vector3<T> lever = antenna_body.cast<T>();
    const Vector3<T> antenna = Vector3<T>(p) + unit(q) * lever;
    Eigen::Map<Vector3<T>> r(residual);
    r = W.cast<T>() * (antenna - antenna_map.cast<T>());
    return true;
  }
};

struct GravityFunctor {
  Eigen::Vector3d up_body;
  double sigma;

  template <typename T>
  bool operator()(const T* q, const T* up_map, const T* offset, T* residual) const {
    const Vector3<T> up = unit(q).conjugate() * Vector3<T>(up_map);
    Eigen::Map<Vector3<T>> r(residual);
    r = (up + Vector3<T>(offset) - up_body.cast<T>()) / T(sigma);
    return true;
  }
};

geometry::Pose3 random_pose(RandomStates& random) {
  const Eigen::Vector4d q = random.quaternion(1.0);
  return geometry::Pose3::from_quaternion(Eigen::Quaterniond(q), random.vector(20));
}

template <int N>
Eigen::Matrix<double, N, N> random_weight(RandomStates& random) {
  using Matrix = Eigen::Matrix<double, N, N>;
  Matrix A;
  for (double& entry : A.reshaped()) entry = random.uniform(-1, 1);
  return square_root_information<N>(A * A.transpose() + Matrix::Identity());
}

const ParameterBlock kRotation{"rotation", 4, true};
const ParameterBlock kTranslation{"translation", 3, false};

/// Rotations stay so small that what two poses differ by is less than half a turn, where Log has
/// no derivative.
FactorSample between_sample(RandomStates& random) {
  const geometry::Pose3 T_i_j = random_pose(random);
  const geometry::Matrix6 W = random_weight<6>(random);
  using Automatic = ceres::AutoDiffCostFunction<BetweenFunctor, 6, 4, 3, 4, 3>;
  return {std::make_shared<BetweenCost>(T_i_j, W),
          std::make_shared<Automatic>(new BetweenFunctor{T_i_j, W}),
          {random.quaternion(1.0), random.vector(50), random.quaternion(1.0), random.vector(50)}};
}

FactorSample antenna_sample(RandomStates& random) {
  const AntennaFunctor fix{random.vector(50), random.vector(3), random_weight<3>(random)};
  using Automatic = ceres::AutoDiffCostFunction<AntennaFunctor, 3, 4, 3>;
  return {std::make_shared<AntennaCost>(fix.antenna_map, fix.antenna_body, fix.W),
          std::make_shared<Automatic>(new AntennaFunctor(fix)),
          {random.quaternion(3), random.vector(50)}};
}

FactorSample gravity_sample(RandomStates& random) {
  const GravityFunctor up{random.unit_vector(), random.uniform(0.05, 0.5)};
  using Automatic = ceres::AutoDiffCostFunction<GravityFunctor, 3, 4, 3, 3>;
  return {std::make_shared<GravityCost>(up.up_body, up.sigma),
          std::make_shared<Automatic>(new GravityFunctor(up)),
          {random.quaternion(3), random.unit_vector(), random.vector(0.5)}};
}

template <typename Make>
FactorKind kind(std::string name, std::string formula, std::vector<ParameterBlock> blocks,
                Make make) {
  return {std::move(name),
          std::move(formula),
          std::move(blocks),
          {Perturbation::kRight},
          [make](RandomStates& random, Perturbation) { return make(random); }};
}

ParameterBlock of(const ParameterBlock& block, const char* node) {
  return {block.name + " " + node, block.size, block.is_rotation};
}

}  // namespace

std::vector<FactorKind> factor_kinds() {
  return {
      kind("between poses", "r = (Log(Rm' Ri' Rj), Ri' (pj - pi) - pm)",
           {of(kRotation, "i"), of(kTranslation, "i"), of(kRotation, "j"), of(kTranslation, "j")},
           between_sample),
      kind("antenna position", "r = p + R l - z", {kRotation, kTranslation}, antenna_sample),
      kind("up direction", "r = R' u + b - um", {kRotation, {"up", 3, false}, {"offset", 3, false}},
           gravity_sample)};
}

}  // namespace traverse::pose_graph
