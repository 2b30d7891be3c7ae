#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace traverse::plausibility {

/// What becomes of a run on a recording with a contradiction in it.
enum class Severity {
  kWarn,    ///< it goes on; the result is worse than it could be
  kRefuse,  ///< it would be garbage where the estimator depends on that sensor
};

std::string_view name_of(Severity severity);  ///< "warn", "refuse"

/// Two things that a recording says, or that it says and that are known of the sensor, which cannot
/// both be true.
struct Finding {
  std::string code;  ///< of the check, snake_case: "imu_in_g"
  Severity severity = Severity::kWarn;
  std::string sensor;       ///< label in the rig of the one that is taken to be wrong; may be empty
  std::string figure;       ///< what was found and what was expected, with units
  std::string consequence;  ///< what it does to a result
  std::string statement;    ///< option that mends it, "--recording imu.unit=g"; empty: none does
  bool is_accepted = false;  ///< the user knows and goes on all the same
};

/// Marks those whose code is among `codes`, which the user knows of.
void mark_accepted(const std::vector<std::string>& codes, std::vector<Finding>& findings);

/// "imu_in_g (IMU): FIGURE. CONSEQUENCE." and, where there is one, "Mended by STATEMENT."
std::string to_text(const Finding& finding);

}  // namespace traverse::plausibility
