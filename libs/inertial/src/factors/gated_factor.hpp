#pragma once

#include <memory>

#include "factors/innovation.hpp"
#include "smoother/fixed_lag_smoother.hpp"

namespace traverse::inertial {

template <typename Model>
using Covariance = Eigen::Matrix<double, Model::kSize, Model::kSize>;

template <typename Model>
std::unique_ptr<StateFactor> make_factor(const Model& model, const Covariance<Model>& R,
                                         double huber = 0) {
  auto factor =
      std::make_unique<ModelFactor<Model>>(model, square_root_information<Model::kSize>(R));
  factor->huber = huber;
  return factor;
}

/// Constrains the newest state, unless chi-square finds the measurement too unlikely.
/// \param R  of the measurement \param gate  false: take it whatever it says
template <typename Model>
Innovation constrain_newest(FixedLagSmoother& smoother, const Model& model,
                            const Covariance<Model>& R, bool gate, double huber = 0) {
  Jacobian<Model::kSize> J;
  const Residual<Model::kSize> r = model(smoother.newest(), &J);
  Innovation found = innovation(r, J, smoother.covariance(), R);
  if (gate && !(found.chi2 <= chi2_bound(Model::kSize))) {  // or it is no number
    found.is_rejected = true;
    return found;
  }
  smoother.add(make_factor(model, R, huber));
  return found;
}

}  // namespace traverse::inertial
