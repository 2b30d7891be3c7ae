#include <array>

#include <fmt/format.h>

#include "checks/check.hpp"

namespace traverse::plausibility {

namespace {

constexpr std::array<CodeMeaning, 1> kRateCodes{
    {{"imu_interval",
      "The median time between the readings of an IMU. Units give 10 to 10 000 a "
      "second: readings more than a second apart are stamped in another unit."}}};

void look_at_rate(const View& view, std::vector<Finding>& findings) {
  const Evidence& evidence = view.evidence;
  constexpr double kLongest_s = 1;
  constexpr std::size_t kMinSamples = 20;
  for (const auto& [label, track] : evidence.imus) {
    const auto interval = track.interval_s();
    if (!interval || track.samples() < kMinSamples || *interval <= kLongest_s) continue;
    const std::string format = evidence.recording.format;
    const char* unit = *interval > 1e5 ? "1e-9" : *interval > 100 ? "1e-6" : "0.001";
    std::string statement;
    if (format == "navigation log") statement = fmt::format("--recording log.time_unit_s={}", unit);
    if (format == "CSV folder") statement = fmt::format("--recording csv.time_unit_s={}", unit);
    findings.push_back(
        {"imu_interval", Severity::kRefuse, label,
         fmt::format("readings are {:.4g} s apart; 0.1 ms to 0.1 s expected", *interval),
         "Nothing can be integrated over such intervals; stamps that count "
         "milliseconds were perhaps read as seconds",
         std::move(statement)});
  }
}

}  // namespace

const Check kImuRate{kRateCodes, look_at_rate};

}  // namespace traverse::plausibility
