#pragma once

#include <map>
#include <optional>
#include <string>

#include "comparison/legs.hpp"
#include "comparison/place_judgement.hpp"
#include "comparison/receiver_delay.hpp"
#include "evidence/evidence.hpp"

namespace traverse::plausibility {

/// The places of a receiver as they agree with the other streams.
struct JudgedReceiver {
  std::optional<ReceiverDelay> delay;
  PlaceJudgement judgement;
  Legs stamped;  ///< under that reading, at the times of the fixes
  Legs legs;     ///< the same at the times that the fixes are of
};

/// What checks look at: the evidence, and what several of them ask of it.
struct View {
  explicit View(const Evidence& all);

  const Evidence& evidence;
  std::map<std::string, JudgedReceiver> receivers;  ///< by label
};

}  // namespace traverse::plausibility
