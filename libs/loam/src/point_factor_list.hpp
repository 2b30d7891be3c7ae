#pragma once

#include <deque>
#include <memory>

#include <ceres/autodiff_cost_function.h>
#include <ceres/numeric_diff_cost_function.h>

#include "traverse/optimization/derivative.hpp"

#include "point_factor.hpp"
#include "point_functor.hpp"

namespace traverse::loam {

/// Factors of one residual with derivatives of any kind. They stay where they are made (deques),
/// since Ceres keeps their addresses.
template <typename Residual>
class PointFactorList {
 public:
  ceres::CostFunction* add(const PointMotion& motion, const Residual& residual,
                           optimization::Derivative derivative) {
    using optimization::Derivative;
    if (derivative == Derivative::kAnalytic) return &analytic_.emplace_back(motion, residual);
    auto functor =
        std::make_unique<PointFunctor<Residual>>(motion.p_lidar(), motion.fraction(), residual);
    if (derivative == Derivative::kAutomatic) return &automatic_.emplace_back(functor.release());
    return &numeric_.emplace_back(functor.release());
  }

 private:
  using Functor = PointFunctor<Residual>;  // owned by Ceres' classes
  std::deque<PointFactor<Residual>> analytic_;
  std::deque<ceres::AutoDiffCostFunction<Functor, Residual::kSize, 4, 3>> automatic_;
  std::deque<ceres::NumericDiffCostFunction<Functor, ceres::CENTRAL, Residual::kSize, 4, 3>>
      numeric_;
};

}  // namespace traverse::loam
