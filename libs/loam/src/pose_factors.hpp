#pragma once

#include <memory>
#include <vector>

#include <ceres/cost_function.h>

#include "traverse/loam/association.hpp"
#include "traverse/loam/registration.hpp"

#include "point_motion.hpp"
#include "point_residuals.hpp"

namespace traverse::loam {

/// The cost functions of one solve, in the forms that the options choose: one a match, first the
/// lines, then the planes. Parameter blocks as of PointFactor.
class PoseFactors {
 public:
  PoseFactors(const Matches& matches, const SolverOptions& options);
  PoseFactors(PoseFactors&&) noexcept;
  PoseFactors& operator=(PoseFactors&&) noexcept;
  ~PoseFactors();

  /// They live as long as this.
  const std::vector<ceres::CostFunction*>& cost_functions() const { return cost_functions_; }

 private:
  struct Lists;
  std::unique_ptr<Lists> lists_;
  std::vector<ceres::CostFunction*> cost_functions_;
};

}  // namespace traverse::loam
