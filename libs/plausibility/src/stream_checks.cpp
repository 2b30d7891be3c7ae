#include "traverse/plausibility/stream_checks.hpp"

#include <algorithm>
#include <exception>
#include <optional>
#include <variant>

#include "checks/check.hpp"
#include "checks/reference.hpp"
#include "evidence/evidence.hpp"

namespace traverse::plausibility {

struct StreamChecks::Parts {
  explicit Parts(const dataset::RecordingInfo& recording) : evidence(recording) {}
  Evidence evidence;
};

StreamChecks::StreamChecks(const dataset::RecordingInfo& recording)
    : parts_(std::make_unique<Parts>(recording)) {}

StreamChecks::~StreamChecks() = default;

void StreamChecks::take(const sensors::Measurement& measurement) {
  parts_->evidence.take(measurement);
}

void StreamChecks::take_pose(geometry::Stamp stamp, const geometry::Pose3& T_map_body) {
  parts_->evidence.take_pose(stamp, T_map_body);
}

void StreamChecks::forget_poses() {
  parts_->evidence.odometry = {};
  parts_->evidence.distortion = {};
}

std::vector<Finding> StreamChecks::findings() const {
  std::vector<Finding> findings;
  const View view(parts_->evidence);
  for (const Check* check : all_checks()) check->look(view, findings);
  mark_accepted(parts_->evidence.recording.accepted_contradictions, findings);
  return findings;
}

std::vector<Finding> survey(dataset::Source& source, const SurveyLimits& limits) {
  source.rewind();
  StreamChecks checks(source.info());
  std::size_t scans = 0;
  std::optional<geometry::Stamp> first;
  for (std::size_t records = 0; records < limits.max_records; ++records) {
    std::optional<sensors::Measurement> measurement;
    try {
      measurement = source.next();
    } catch (const std::exception&) {
      break;  // whoever reads it for good tells
    }
    if (!measurement) break;
    checks.take(*measurement);
    const geometry::Stamp stamp = sensors::stamp_of(*measurement);
    if (!first) first = stamp;
    if (geometry::seconds_between(*first, stamp) > limits.max_seconds) break;
    const bool is_scan =
        std::holds_alternative<std::shared_ptr<const sensors::LidarScan>>(*measurement);
    if (is_scan && ++scans >= limits.max_scans) break;
  }
  source.rewind();
  return checks.findings();
}

std::vector<CheckDescription> list_checks() {
  std::vector<CheckDescription> descriptions;
  for (const Check* check : all_checks()) {
    for (const CodeMeaning& meaning : check->codes) {
      descriptions.push_back({meaning.code, meaning.holds});
    }
  }
  for (const CodeMeaning& meaning : reference_codes()) {
    descriptions.push_back({meaning.code, meaning.holds});
  }
  return descriptions;
}

}  // namespace traverse::plausibility
