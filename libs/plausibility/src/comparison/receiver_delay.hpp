#pragma once

#include <optional>
#include <string>

#include "comparison/delay.hpp"
#include "comparison/legs.hpp"
#include "evidence/evidence.hpp"

namespace traverse::plausibility {

/// How late the fixes of a receiver are, and against what.
struct ReceiverDelay {
  Delay delay;
  std::string against;
};

/// By distances and turns between fixes against those of lidar odometry, wheels or gyro, whatever
/// their scale and sign; the one by which most is gained. Nothing that is not marked: receivers
/// tell where they were up to 0.15 s ago, and where an antenna that is ahead of the axle goes the
/// body points to later.
std::optional<ReceiverDelay> find_receiver_delay(const Evidence& evidence,
                                                 const std::string& receiver, const Legs& legs);

}  // namespace traverse::plausibility
