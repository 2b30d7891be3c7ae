#pragma once

#include <ceres/loss_function.h>

namespace traverse::pose_graph {

/// The weight of a chi-square under dynamic covariance scaling with the bound B:
/// min(1, 2 B / (B + chi2))^2. Source: Agarwal et al., ICRA 2013, eq. 15, whose scale is its root.
inline double scaling_weight(double chi2, double bound) {
  if (chi2 <= bound) return 1;
  const double scale = 2 * bound / (bound + chi2);
  return scale * scale;
}

/// The loss whose derivative is that weight: chi2 up to the bound, B (3 chi2 - B) / (chi2 + B)
/// beyond (MacTavish and Barfoot, "At all costs", CRV 2015, table I).
inline double scaled_cost(double chi2, double bound) {
  return chi2 <= bound ? chi2 : bound * (3 * chi2 - bound) / (chi2 + bound);
}

/// The same for Ceres, with a bound that can be wider for a while.
class ScalingLoss final : public ceres::LossFunction {
 public:
  explicit ScalingLoss(double final_bound) : final_bound_(final_bound), bound_(final_bound) {}

  void widen(double factor) { bound_ = factor * final_bound_; }
  double final_bound() const { return final_bound_; }
  double bound() const { return bound_; }

  void Evaluate(double chi2, double rho[3]) const override {
    rho[0] = scaled_cost(chi2, bound_);
    rho[1] = scaling_weight(chi2, bound_);
    rho[2] = chi2 <= bound_ ? 0 : -2 * rho[1] / (chi2 + bound_);
  }

 private:
  double final_bound_;
  double bound_;
};

}  // namespace traverse::pose_graph
