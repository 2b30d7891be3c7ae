#pragma once

#include <span>
#include <string>
#include <vector>

#include "traverse/plausibility/finding.hpp"

#include "comparison/view.hpp"

namespace traverse::plausibility {

/// A code that a check can give and, for the documentation, what it holds against what.
struct CodeMeaning {
  const char* code;
  const char* holds;
};

/// One idea of how streams can contradict each other, in a file of its own, from physics and the
/// noise of sensors alone.
struct Check {
  std::span<const CodeMeaning> codes;
  void (*look)(const View& view, std::vector<Finding>& findings);
};

extern const Check kImuRate;
extern const Check kImuGravity;
extern const Check kImuUpright;
extern const Check kImuMounting;
extern const Check kGyroTurns;
extern const Check kWheelDistance;
extern const Check kGnssPlace;
extern const Check kGnssHeading;
extern const Check kGnssTime;
extern const Check kLidarTime;
extern const Check kPointTimes;
extern const Check kDeskew;
extern const Check kRanges;

/// All of them, in the order in which their findings are told.
std::span<const Check* const> all_checks();

}  // namespace traverse::plausibility
