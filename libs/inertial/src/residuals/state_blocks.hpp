#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <ceres/sized_cost_function.h>

#include "traverse/optimization/rotation_manifold.hpp"

#include "residuals/residual.hpp"

/// A NavState as Ceres' parameter blocks, in this order: quaternion [x y z w] of R_map_body on
/// RotationManifold, position, velocity, gyro bias, accelerometer bias, wheel scale, wheel
/// turn, GNSS latency, GNSS bias.
namespace traverse::inertial {

inline constexpr int kStateBlocks = 9;

inline NavState state_of(double const* const* blocks) {
  using Map = Eigen::Map<const Eigen::Vector3d>;
  NavState x;
  // Normalised here, because gradient checks step off the unit sphere.
  x.q_map_body = Eigen::Map<const Eigen::Quaterniond>(blocks[0]).normalized();
  x.p_map = Map(blocks[1]);
  x.v_map = Map(blocks[2]);
  x.gyro_bias = Map(blocks[3]);
  x.accelerometer_bias = Map(blocks[4]);
  x.wheel_scale = *blocks[5];
  x.wheel_turn = Eigen::Map<const Eigen::Vector2d>(blocks[6]);
  x.gnss_latency = *blocks[7];
  x.gnss_bias = Map(blocks[8]);
  return x;
}

/// Spreads a Jacobian in the tangent of `x` over the blocks that are asked for.
template <int N>
void spread(const Jacobian<N>& J, const NavState& x, double** blocks) {
  const auto put = [&]<int kSize>(double* block, const Eigen::Matrix<double, N, kSize>& values) {
    if (block == nullptr) return;
    constexpr int kOrder = kSize == 1 ? Eigen::ColMajor : Eigen::RowMajor;
    Eigen::Map<Eigen::Matrix<double, N, kSize, kOrder>> target(block);
    target = values;
  };
  using optimization::RotationManifold;
  const auto P = RotationManifold::plus_jacobian(x.q_map_body.coeffs().data(),
                                                 optimization::Perturbation::kRight);
  put.template operator()<4>(blocks[0],
                             4 * J.template middleCols<3>(NavState::kRotation) * P.transpose());
  put.template operator()<3>(blocks[1], J.template middleCols<3>(NavState::kPosition));
  put.template operator()<3>(blocks[2], J.template middleCols<3>(NavState::kVelocity));
  put.template operator()<3>(blocks[3], J.template middleCols<3>(NavState::kGyroBias));
  put.template operator()<3>(blocks[4], J.template middleCols<3>(NavState::kAccelerometerBias));
  put.template operator()<1>(blocks[5], J.template middleCols<1>(NavState::kWheelScale));
  put.template operator()<2>(blocks[6], J.template middleCols<2>(NavState::kWheelTurn));
  put.template operator()<1>(blocks[7], J.template middleCols<1>(NavState::kGnssLatency));
  put.template operator()<3>(blocks[8], J.template middleCols<3>(NavState::kGnssBias));
}

/// A residual of one state for Ceres. Model: a residual as residual.hpp says.
template <typename Model>
class StateCost final : public ceres::SizedCostFunction<Model::kSize, 4, 3, 3, 3, 3, 1, 2, 1, 3> {
 public:
  explicit StateCost(Model model) : model_(std::move(model)) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const NavState x = state_of(parameters);
    Jacobian<Model::kSize> J;
    Eigen::Map<Residual<Model::kSize>> r(residuals);
    r = model_(x, jacobians == nullptr ? nullptr : &J);
    if (jacobians != nullptr) spread(J, x, jacobians);
    return true;
  }

 private:
  Model model_;
};

/// A residual of two states for Ceres: the blocks of i, then those of j. Model has kSize and
/// Residual<kSize> operator()(const NavState& i, const NavState& j, Jacobian<kSize>* dr_di,
/// Jacobian<kSize>* dr_dj) const.
template <typename Model>
class LinkCost final : public ceres::SizedCostFunction<Model::kSize, 4, 3, 3, 3, 3, 1, 2, 1, 3, 4,
                                                       3, 3, 3, 3, 1, 2, 1> {
 public:
  explicit LinkCost(Model model) : model_(std::move(model)) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const NavState i = state_of(parameters);
    const NavState j = state_of(parameters + kStateBlocks);
    Eigen::Map<Residual<Model::kSize>> r(residuals);
    if (jacobians == nullptr) {
      r = model_(i, j, nullptr, nullptr);
      return true;
    }
    Jacobian<Model::kSize> Ji;
    Jacobian<Model::kSize> Jj;
    r = model_(i, j, &Ji, &Jj);
    spread(Ji, i, jacobians);
    spread(Jj, j, jacobians + kStateBlocks);
    return true;
  }

 private:
  Model model_;
};

}  // namespace traverse::inertial
