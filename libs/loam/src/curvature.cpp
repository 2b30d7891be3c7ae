#include "curvature.hpp"

#include <cmath>

namespace traverse::loam {

std::vector<float> curvature(const lidar::ScanLines& lines) {
  constexpr std::size_t kReach = kCurvatureReach;
  constexpr auto kNeighbours = static_cast<float>(2 * kReach);
  std::vector<float> c(lines.size(), kNoCurvature);
  for (std::size_t k = 0; k < lines.line_count(); ++k) {
    const std::size_t begin = lines.line_begin[k];
    const std::size_t end = lines.line_begin[k + 1];
    for (std::size_t i = begin + kReach; i + kReach < end; ++i) {
      float dx = 0;
      float dy = 0;
      float dz = 0;
      for (std::size_t j = i - kReach; j <= i + kReach; ++j) {  // j = i adds nothing
        dx += lines.x[j] - lines.x[i];
        dy += lines.y[j] - lines.y[i];
        dz += lines.z[j] - lines.z[i];
      }
      c[i] = std::sqrt(dx * dx + dy * dy + dz * dz) / (kNeighbours * lines.range[i]);
    }
  }
  return c;
}

}  // namespace traverse::loam
