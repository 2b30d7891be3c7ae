#include <array>
#include <numbers>

#include "traverse/packets/velodyne.hpp"

namespace traverse::packets {

namespace {

constexpr double kLaserDegree = std::numbers::pi / 180;

// calibration/VLP16.yaml of tier4/nebula 606ac41.
constexpr std::array kVlp16{-15.0, 1.0, -13.0, 3.0,  -11.0, 5.0,  -9.0, 7.0,
                            -7.0,  9.0, -5.0,  11.0, -3.0,  13.0, -1.0, 15.0};

// calibration/VLP16_hires.yaml of tier4/nebula
// 606ac41.
constexpr std::array kVlp16HiRes{-10.0,  0.667, -8.667, 2.0,   -7.333, 3.333, -6.0,   4.667,
                                 -4.667, 6.0,   -3.333, 7.333, -2.0,   8.667, -0.667, 10.0};

// params/VeloView-VLP-32C.yaml of
// ros-drivers/velodyne 29abd0e.
constexpr std::array kVlp32c{-25.0,  -1.0,  -1.667, -15.639, -11.31, 0.0,   -0.667, -8.843,
                             -7.254, 0.333, -0.333, -6.148,  -5.333, 1.333, 0.667,  -4.0,
                             -4.667, 1.667, 1.0,    -3.667,  -3.333, 3.333, 2.333,  -2.667,
                             -3.0,   7.0,   4.667,  -2.333,  -2.0,   15.0,  10.333, -1.333};
constexpr std::array kVlp32cAzimuths{
    -1.4, 4.2, -1.4, 1.4, -1.4, 1.4, -4.2, 1.4, -1.4, 4.2, -1.4, 1.4, -4.2, 1.4, -4.2, 1.4,
    -1.4, 4.2, -1.4, 4.2, -4.2, 1.4, -1.4, 1.4, -1.4, 1.4, -1.4, 4.2, -4.2, 1.4, -1.4, 1.4};

// params/32db.yaml of ros-drivers/velodyne
// 29abd0e.
constexpr std::array kHdl32e{-30.67, -9.33, -29.33, -8.0,  -28.0,  -6.67, -26.67, -5.33,
                             -25.33, -4.0,  -24.0,  -2.67, -22.67, -1.33, -21.33, 0.0,
                             -20.0,  1.33,  -18.67, 2.67,  -17.33, 4.0,   -16.0,  5.33,
                             -14.67, 6.67,  -13.33, 8.0,   -12.0,  9.33,  -10.67, 10.67};

// params/VLS128.yaml of ros-drivers/velodyne
// 29abd0e. The azimuths repeat every eight lasers.
constexpr std::array kVls128{
    -11.742, -1.99,   3.4,   -5.29,   -0.78, 4.61,  -4.08,   1.31,   -6.5,  -1.11,   4.28,  -4.41,
    0.1,     6.48,    -3.2,  2.19,    -3.86, 1.53,  -9.244,  -1.77,  2.74,  -5.95,   -0.56, 4.83,
    -2.98,   2.41,    -6.28, -0.89,   3.62,  -5.07, 0.32,    7.58,   -0.34, 5.18,    -3.64, 1.75,
    -25.0,   -2.43,   2.96,  -5.73,   0.54,  9.7,   -2.76,   2.63,   -7.65, -1.55,   3.84,  -4.85,
    3.18,    -5.51,   -0.12, 5.73,    -4.3,  1.09,  -16.042, -2.21,  4.06,  -4.63,   0.76,  15.0,
    -3.42,   1.97,    -6.85, -1.33,   -5.62, -0.23, 5.43,    -3.53,  0.98,  -19.582, -2.32, 3.07,
    -4.74,   0.65,    11.75, -2.65,   1.86,  -7.15, -1.44,   3.95,   -2.1,  3.29,    -5.4,  -0.01,
    4.5,     -4.19,   1.2,   -13.565, -1.22, 4.17,  -4.52,   0.87,   6.08,  -3.31,   2.08,  -6.65,
    1.42,    -10.346, -1.88, 3.51,    -6.06, -0.67, 4.72,    -3.97,  2.3,   -6.39,   -1.0,  4.39,
    -5.18,   0.21,    6.98,  -3.09,   4.98,  -3.75, 1.64,    -8.352, -2.54, 2.85,    -5.84, -0.45,
    8.43,    -2.87,   2.52,  -6.17,   -1.66, 3.73,  -4.96,   0.43};
constexpr std::array kVls128Azimuths{-6.354, -4.548, -2.732, -0.911, 0.911, 2.732, 4.548, 6.354};

std::vector<VelodyneLaser> lasers_at(std::span<const double> elevations_deg,
                                     std::span<const double> azimuths_deg) {
  std::vector<VelodyneLaser> lasers;
  for (std::size_t i = 0; i < elevations_deg.size(); ++i) {
    const double azimuth_deg = azimuths_deg.empty() ? 0 : azimuths_deg[i % azimuths_deg.size()];
    lasers.push_back({elevations_deg[i] * kLaserDegree, azimuth_deg * kLaserDegree, 0, 0, 0});
  }
  return lasers;
}

}  // namespace

std::vector<VelodyneLaser> velodyne_lasers(VelodyneModel model) {
  switch (model) {
    case VelodyneModel::kVlp16:
      return lasers_at(kVlp16, {});
    case VelodyneModel::kVlp16HiRes:
      return lasers_at(kVlp16HiRes, {});
    case VelodyneModel::kVlp32c:
      return lasers_at(kVlp32c, kVlp32cAzimuths);
    case VelodyneModel::kHdl32e:
      return lasers_at(kHdl32e, {});
    case VelodyneModel::kHdl64e:
      return {};
    case VelodyneModel::kVls128:
      return lasers_at(kVls128, kVls128Azimuths);
  }
  return {};
}

}  // namespace traverse::packets
