#include <array>

#include "checks/check.hpp"

namespace traverse::plausibility {

std::span<const Check* const> all_checks() {
  static constexpr std::array kAll{&kRanges,      &kPointTimes, &kDeskew,        &kImuRate,
                                   &kImuGravity,  &kImuUpright, &kGnssPlace,     &kGyroTurns,
                                   &kImuMounting, &kLidarTime,  &kWheelDistance, &kGnssHeading,
                                   &kGnssTime};
  return kAll;
}

}  // namespace traverse::plausibility
