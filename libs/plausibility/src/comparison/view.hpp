#pragma once

#include <map>
#include <string>

#include "comparison/legs.hpp"
#include "comparison/place_judgement.hpp"
#include "evidence/evidence.hpp"

namespace traverse::plausibility {

/// The places of a receiver as they agree with the other streams.
struct JudgedReceiver {
  PlaceJudgement judgement;
  Legs legs;  ///< under that reading
};

/// What checks look at: the evidence, and what several of them ask of it.
struct View {
  explicit View(const Evidence& all);

  const Evidence& evidence;
  std::map<std::string, JudgedReceiver> receivers;  ///< by label
};

}  // namespace traverse::plausibility
