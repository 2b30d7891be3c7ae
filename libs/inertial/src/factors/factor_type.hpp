#pragma once

#include <array>
#include <string_view>
#include <utility>

namespace traverse::inertial {

/// What can constrain states.
enum class FactorType {
  kInertial,
  kGyroBiasWalk,
  kAccelerometerBiasWalk,
  kWheelScaleWalk,
  kWheelTurnWalk,
  kGnssLatencyWalk,
  kGnssBiasWalk,
  kPrior,
  kGnssPosition,
  kHeading,
  kWheelVelocity,
  kZeroVelocity,
  kGnssPose,
  kWorldVelocity
};

inline constexpr std::array<std::pair<std::string_view, FactorType>, 14> kFactorTypeNames{
    {{"inertial", FactorType::kInertial},
     {"gyro bias walk", FactorType::kGyroBiasWalk},
     {"accelerometer bias walk", FactorType::kAccelerometerBiasWalk},
     {"wheel scale walk", FactorType::kWheelScaleWalk},
     {"wheel turn walk", FactorType::kWheelTurnWalk},
     {"GNSS latency walk", FactorType::kGnssLatencyWalk},
     {"GNSS bias walk", FactorType::kGnssBiasWalk},
     {"prior", FactorType::kPrior},
     {"GNSS position", FactorType::kGnssPosition},
     {"heading", FactorType::kHeading},
     {"wheel velocity", FactorType::kWheelVelocity},
     {"zero velocity", FactorType::kZeroVelocity},
     {"GNSS pose", FactorType::kGnssPose},
     {"world velocity", FactorType::kWorldVelocity}}};

constexpr std::string_view name_of(FactorType type) {
  return kFactorTypeNames[static_cast<std::size_t>(type)].first;
}

}  // namespace traverse::inertial
