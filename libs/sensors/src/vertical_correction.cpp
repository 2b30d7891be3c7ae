#include "traverse/sensors/vertical_correction.hpp"

#include <cmath>

namespace traverse::sensors {

void correct_elevation(float* x, float* y, float* z, std::size_t n, double angle) {
  const auto c = static_cast<float>(std::cos(angle));
  const auto s = static_cast<float>(std::sin(angle));
  for (std::size_t i = 0; i < n; ++i) {
    const float horizontal = std::sqrt(x[i] * x[i] + y[i] * y[i]);
    if (!(horizontal > 1e-6F)) continue;
    const float stretch = c - s * z[i] / horizontal;
    x[i] *= stretch;
    y[i] *= stretch;
    z[i] = c * z[i] + s * horizontal;
  }
}

}  // namespace traverse::sensors
