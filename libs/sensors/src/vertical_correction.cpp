#include "traverse/sensors/vertical_correction.hpp"

#include <cmath>

namespace traverse::sensors {

void correct_elevation(float* x, float* y, float* z, std::size_t n, double angle) {
  const auto c = static_cast<float>(std::cos(angle));
  const auto s = static_cast<float>(std::sin(angle));
  for (std::size_t i = 0; i < n; ++i) {
    const float horizontal = std::sqrt(x[i] * x[i] + y[i] * y[i]);
    const bool has_azimuth = horizontal > 1e-6F;  // selected, not branched on: the loop vectorises
    const float stretch = has_azimuth ? c - s * z[i] / horizontal : 1.0F;
    const float raised = has_azimuth ? c * z[i] + s * horizontal : z[i];
    x[i] *= stretch;
    y[i] *= stretch;
    z[i] = raised;
  }
}

}  // namespace traverse::sensors
