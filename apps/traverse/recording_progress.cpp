#include "recording_progress.hpp"

#include <memory>
#include <variant>

namespace traverse::app {

RecordingProgress::RecordingProgress(const std::string& verb, const dataset::Source& source)
    : source_(source),
      bar_(verb + " " + source.info().name, source.info().expected_scans, "scans") {}

void RecordingProgress::update(const sensors::Measurement& measurement) {
  const bool is_scan =
      std::holds_alternative<std::shared_ptr<const sensors::LidarScan>>(measurement);
  scans_ += is_scan ? 1 : 0;
  bar_.update(scans_, source_.share_read());
}

}  // namespace traverse::app
