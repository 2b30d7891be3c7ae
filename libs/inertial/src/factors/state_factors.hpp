#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string_view>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "traverse/inertial/residuals.hpp"

#include "factors/factor_type.hpp"

namespace traverse::inertial {

/// A residual's rows and their derivatives, on the stack.
using Rows = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;
using RowsJacobian =
    Eigen::Matrix<double, Eigen::Dynamic, NavState::kTangent, 0, 6, NavState::kTangent>;

/// The W for which |W r|^2 = r' covariance^-1 r.
template <int N>
Eigen::Matrix<double, N, N> square_root_information(const Eigen::Matrix<double, N, N>& covariance) {
  using Matrix = Eigen::Matrix<double, N, N>;
  const Eigen::LLT<Matrix> llt(covariance);
  Matrix W = Matrix::Identity();
  llt.matrixL().solveInPlace(W);
  return W;
}

/// A constraint on one state, in units of its standard deviation.
class StateFactor {
 public:
  virtual ~StateFactor() = default;

  virtual FactorType type() const = 0;
  virtual void evaluate(const NavState& x, Rows& r, RowsJacobian* dr_dx) const = 0;

  /// Where Huber's loss goes over from a square to a line, in standard deviations; 0 for never.
  double huber = 0;
};

/// A StateFactor from a model: a type with kSize, kType and
/// Residual<kSize> operator()(const NavState& x, Jacobian<kSize>* dr_dx) const.
template <typename Model>
class ModelFactor final : public StateFactor {
 public:
  static constexpr int kSize = Model::kSize;
  using Weight = Eigen::Matrix<double, kSize, kSize>;

  ModelFactor(const Model& model, const Weight& square_root_information)
      : model_(model), weight_(square_root_information) {}

  FactorType type() const override { return Model::kType; }
  void evaluate(const NavState& x, Rows& r, RowsJacobian* dr_dx) const override {
    if (dr_dx == nullptr) {
      r = weight_ * model_(x, nullptr);
      return;
    }
    Jacobian<kSize> J;
    r = weight_ * model_(x, &J);
    *dr_dx = weight_ * J;
  }

 private:
  Model model_;
  Weight weight_;
};

struct GnssPositionModel {
  static constexpr int kSize = 3;
  static constexpr FactorType kType = FactorType::kGnssPosition;
  AntennaFix fix;
  Residual<3> operator()(const NavState& x, Jacobian<3>* J) const {
    return gnss_position_residual(fix, x, J);
  }
};

struct HeadingModel {
  static constexpr int kSize = 1;
  static constexpr FactorType kType = FactorType::kHeading;
  double heading;
  Residual<1> operator()(const NavState& x, Jacobian<1>* J) const {
    return heading_residual(heading, x, J);
  }
};

struct WheelVelocityModel {
  static constexpr int kSize = 3;
  static constexpr FactorType kType = FactorType::kWheelVelocity;
  double forward_mps;
  WheelMount mount;
  Eigen::Vector3d angular_rate;
  Residual<3> operator()(const NavState& x, Jacobian<3>* J) const {
    return wheel_velocity_residual(forward_mps, mount, angular_rate, x, J);
  }
};

struct ZeroVelocityModel {
  static constexpr int kSize = 6;
  static constexpr FactorType kType = FactorType::kZeroVelocity;
  Eigen::Vector3d angular_rate;
  Residual<6> operator()(const NavState& x, Jacobian<6>* J) const {
    return zero_velocity_residual(angular_rate, x, J);
  }
};

struct GnssPoseModel {
  static constexpr int kSize = 6;
  static constexpr FactorType kType = FactorType::kGnssPose;
  geometry::Pose3 T_map_body_measured;
  Residual<6> operator()(const NavState& x, Jacobian<6>* J) const {
    return gnss_pose_residual(T_map_body_measured, x, J);
  }
};

struct WorldVelocityModel {
  static constexpr int kSize = 3;
  static constexpr FactorType kType = FactorType::kWorldVelocity;
  Eigen::Vector3d v_map_measured;
  Residual<3> operator()(const NavState& x, Jacobian<3>* J) const {
    return world_velocity_residual(v_map_measured, x, J);
  }
};

struct PriorModel {
  static constexpr int kSize = NavState::kTangent;
  static constexpr FactorType kType = FactorType::kPrior;
  NavState expected;
  Residual<kSize> operator()(const NavState& x, Jacobian<kSize>* J) const {
    return prior_residual(expected, x, J);
  }
};

}  // namespace traverse::inertial
