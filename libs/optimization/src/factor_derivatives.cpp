#include "factor_derivatives.hpp"

#include <algorithm>
#include <limits>

#include "traverse/optimization/rotation_manifold.hpp"

namespace traverse::optimization {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::vector<const double*> pointers(const State& state) {
  std::vector<const double*> result;
  for (const Eigen::VectorXd& block : state) result.push_back(block.data());
  return result;
}

Eigen::VectorXd value(const ceres::CostFunction& factor, const State& state) {
  Eigen::VectorXd r(factor.num_residuals());
  if (!factor.Evaluate(pointers(state).data(), r.data(), nullptr)) r.setConstant(kNaN);
  return r;
}

int tangent_size(const ParameterBlock& block) { return block.is_rotation ? 3 : block.size; }

Eigen::VectorXd moved(const ParameterBlock& block, Perturbation perturbation,
                      const Eigen::VectorXd& x, const Eigen::VectorXd& delta) {
  if (!block.is_rotation) return x + delta;
  Eigen::VectorXd result(x.size());
  RotationManifold(perturbation).Plus(x.data(), delta.data(), result.data());
  return result;
}

/// Small against the scale on which residuals bend, large against rounding.
double step_of(const ParameterBlock& block, const Eigen::VectorXd& x) {
  constexpr double kStep = 1e-4;
  return block.is_rotation ? kStep : kStep * std::max(1.0, x.lpNorm<Eigen::Infinity>());
}

}  // namespace

Linearised linearise(const ceres::CostFunction& factor, std::span<const ParameterBlock> blocks,
                     Perturbation perturbation, const State& state) {
  Linearised result;
  result.residual.resize(factor.num_residuals());
  std::vector<RowMajor> ambient;
  std::vector<double*> jacobians;
  for (const ParameterBlock& block : blocks) {
    ambient.emplace_back(factor.num_residuals(), block.size);
  }
  for (RowMajor& jacobian : ambient) jacobians.push_back(jacobian.data());
  const bool evaluated =
      factor.Evaluate(pointers(state).data(), result.residual.data(), jacobians.data());
  if (!evaluated) {
    result.residual.setConstant(kNaN);
    for (RowMajor& jacobian : ambient) jacobian.setConstant(kNaN);
  }
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    if (blocks[k].is_rotation) {
      result.jacobians.emplace_back(ambient[k] *
                                    RotationManifold::plus_jacobian(state[k].data(), perturbation));
    } else {
      result.jacobians.emplace_back(ambient[k]);
    }
  }
  return result;
}

std::vector<Eigen::MatrixXd> central_differences(const ceres::CostFunction& factor,
                                                 std::span<const ParameterBlock> blocks,
                                                 Perturbation perturbation, const State& state) {
  std::vector<Eigen::MatrixXd> jacobians;
  State near = state;
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    const int columns = tangent_size(blocks[k]);
    const double h = step_of(blocks[k], state[k]);
    Eigen::MatrixXd& jacobian = jacobians.emplace_back(factor.num_residuals(), columns);
    for (int column = 0; column < columns; ++column) {
      const auto at = [&](double step) {
        near[k] =
            moved(blocks[k], perturbation, state[k], step * Eigen::VectorXd::Unit(columns, column));
        return value(factor, near);
      };
      jacobian.col(column) = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
    }
    near[k] = state[k];
  }
  return jacobians;
}

}  // namespace traverse::optimization
