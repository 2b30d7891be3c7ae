#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>
#include <ceres/cost_function.h>

#include "traverse/optimization/factor_kind.hpp"

namespace traverse::optimization {

using State = std::vector<Eigen::VectorXd>;

/// Value of a factor, and its Jacobian in the tangent space of each block.
struct Linearised {
  Eigen::VectorXd residual;
  std::vector<Eigen::MatrixXd> jacobians;
};

/// By the cost function's own Jacobians, all NaN if it cannot be evaluated.
Linearised linearise(const ceres::CostFunction& factor, std::span<const ParameterBlock> blocks,
                     Perturbation perturbation, const State& state);

/// By central differences of fourth order of the cost function's value.
std::vector<Eigen::MatrixXd> central_differences(const ceres::CostFunction& factor,
                                                 std::span<const ParameterBlock> blocks,
                                                 Perturbation perturbation, const State& state);

}  // namespace traverse::optimization
