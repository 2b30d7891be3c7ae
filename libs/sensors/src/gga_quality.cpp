#include "traverse/sensors/gga_quality.hpp"

#include <array>
#include <cmath>

namespace traverse::sensors {

namespace {

struct QualitySigma {
  int quality;
  double horizontal_m;
};
/// From the best to the worst.
constexpr std::array<QualitySigma, 4> kQualitySigmas{{{4, 0.02}, {5, 0.3}, {2, 1}, {1, 2}}};
constexpr double kInHeight = 2;  // times as much

}  // namespace

bool is_gga_fix(int quality) { return quality > 0 && (quality < 6 || quality > 8); }

std::optional<Eigen::Matrix3d> covariance_of_gga_quality(int quality) {
  for (const QualitySigma& known : kQualitySigmas) {
    if (known.quality != quality) continue;
    const double h = known.horizontal_m;
    const Eigen::Vector3d sigma(h, h, kInHeight * h);
    return Eigen::Matrix3d(sigma.cwiseAbs2().asDiagonal());
  }
  return std::nullopt;
}

int gga_quality_of(const Eigen::Matrix3d& covariance_enu) {
  const double sigma = std::sqrt(covariance_enu.topLeftCorner<2, 2>().trace() / 2);
  for (std::size_t k = 0; k + 1 < kQualitySigmas.size(); ++k) {
    // Half way between two, by ratio.
    const double bound =
        std::sqrt(kQualitySigmas.at(k).horizontal_m * kQualitySigmas.at(k + 1).horizontal_m);
    if (sigma < bound) return kQualitySigmas.at(k).quality;
  }
  return kQualitySigmas.back().quality;
}

}  // namespace traverse::sensors
