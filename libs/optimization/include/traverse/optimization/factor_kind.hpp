#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "traverse/optimization/perturbation.hpp"
#include "traverse/optimization/random_states.hpp"

namespace ceres {
class CostFunction;
}

/// How a library registers its factors for the check of their Jacobians: it returns one FactorKind
/// for each, as loam::factor_kinds() does, and pipeline::factor_kinds() lists it.
namespace traverse::optimization {

/// A parameter block of a factor.
struct ParameterBlock {
  std::string name;          ///< "rotation", "translation", "gyro bias"
  int size = 3;              ///< numbers; 4 for a rotation: a unit quaternion [x y z w]
  bool is_rotation = false;  ///< moved on RotationManifold, all others by addition
};

/// One instance of a factor with a state at which it is checked. Both cost functions are the same
/// residual; the Jacobians of `analytic` are those that the project derived (ambient ones, see
/// RotationManifold), those of `automatic` come from dual numbers.
struct FactorSample {
  std::shared_ptr<const ceres::CostFunction> analytic;
  std::shared_ptr<const ceres::CostFunction> automatic;
  std::vector<Eigen::VectorXd> state;  ///< one a parameter block
};

/// A kind of factor that can be checked.
struct FactorKind {
  std::string name;     ///< "line vector"
  std::string formula;  ///< for people: "r = u × (q − c)"
  std::vector<ParameterBlock> blocks;
  std::vector<Perturbation> perturbations;  ///< those that its Jacobians are derived for

  /// A random instance and state away from zero residual: at zero many mistakes cannot be seen.
  std::function<FactorSample(RandomStates& random, Perturbation perturbation)> make;
};

/// A factor that an estimator works with, by the name of its kind.
struct FactorUse {
  std::string factor;
  Perturbation perturbation = Perturbation::kRight;
};

}  // namespace traverse::optimization
