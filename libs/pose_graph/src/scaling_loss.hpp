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
class ScalingLoss final : public ceres::LossFunction {
 public:
  explicit ScalingLoss(double final_bound) : final_bound_(final_bound), bound_(final_bound) {}

  void widen(double factor) { bound_ = factor * final_bound_; }
  double final_bound() const { return final_bound_; }

  void Evaluate(double chi2, double rho[3]) const override {
    const double B = bound_;
    if (chi2 <= B) {
      rho[0] = chi2;
      rho[1] = 1;
      rho[2] = 0;
      return;
    }
    rho[0] = B * (3 * chi2 - B) / (chi2 + B);
    rho[1] = scaling_weight(chi2, B);
    rho[2] = -2 * rho[1] / (chi2 + B);
  }

 private:
  double final_bound_;
  double bound_;
};

}  // namespace traverse::pose_graph
