#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "traverse/batch/job.hpp"

namespace traverse::batch {

/// How a run ended.
enum class Outcome { kOk, kDegraded, kLost, kFailed, kTimedOut, kOutOfMemory, kCrashed };

/// Whether its figures count: ok, or degraded, which is usable with what is said of it. A run that
/// is lost has figures too, of a path that nobody drove.
constexpr bool is_usable(Outcome outcome) {
  return outcome == Outcome::kOk || outcome == Outcome::kDegraded;
}

inline constexpr std::array<std::pair<std::string_view, Outcome>, 7> kOutcomeNames{
    {{"ok", Outcome::kOk},
     {"degraded", Outcome::kDegraded},
     {"lost", Outcome::kLost},
     {"failed", Outcome::kFailed},
     {"timed out", Outcome::kTimedOut},
     {"out of memory", Outcome::kOutOfMemory},
     {"crashed", Outcome::kCrashed}}};
std::string_view name_of(Outcome outcome);

/// A named figure of a run.
using MetricValue = std::pair<std::string, double>;

/// The record that makes a run finished: result.json, written into the run's folder before that
/// folder gets its name.
struct Completion {
  std::string id;
  std::string identity;
  Outcome outcome = Outcome::kFailed;
  std::string reason;   ///< empty if ok
  int exit_status = 0;  ///< of the process, when it ended by itself
  int signal = 0;       ///< that ended it, or 0
  int attempts = 1;
  std::string host;
  std::string started_utc;
  double wall_s = 0;  ///< from the start of the process to its end
  double cpu_s = 0;   ///< user and system
  double peak_memory_mb = 0;
  RunLimits limits;
  bool has_report = false;
  std::string trajectory_sha256;        ///< empty if there is none
  std::vector<MetricValue> metrics;     ///< in a fixed order
  std::vector<std::string> last_lines;  ///< of the log, unless ok
};

std::string to_json(const Completion& completion);
/// \throws files::InputError if `file` is missing or is not such a record.
Completion read_completion(const std::filesystem::path& file);

/// The record of a finished run; nothing if there is none or it is not whole.
std::optional<Completion> find_completion(const std::filesystem::path& file);

/// Whether a finished run must be made again: it was ended by a limit that is another now.
bool is_outdated(const Completion& completion, const Job& job);

}  // namespace traverse::batch
