#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "traverse/optimization/factor_kind.hpp"
#include "traverse/optimization/jacobian_audit.hpp"

namespace traverse::optimization {

/// The Jacobian of one parameter block at one state, in the tangent space, made three ways.
struct ShownBlock {
  std::string block;
  Eigen::MatrixXd analytic;   ///< rows of the residual x size of the tangent
  Eigen::MatrixXd automatic;  ///< by dual numbers
  Eigen::MatrixXd numeric;    ///< by central differences
};

struct ShownFactor {
  std::string factor;
  std::string formula;
  Perturbation perturbation = Perturbation::kRight;
  Eigen::VectorXd residual;
  std::vector<ShownBlock> blocks;
};

/// The Jacobians of the first random state that audit_jacobians() looks at.
/// \throws std::invalid_argument for a factor whose residual is never options.min_residual.
ShownFactor show_jacobians(const FactorKind& kind, Perturbation perturbation,
                           const AuditOptions& options);

}  // namespace traverse::optimization
