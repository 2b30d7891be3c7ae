#pragma once

#include <deque>
#include <memory>
#include <variant>

#include "traverse/geometry/stamp.hpp"
#include "traverse/sensors/measurement.hpp"

namespace traverse::pipeline {

using ScanPtr = std::shared_ptr<const sensors::LidarScan>;

/// Keeps the scans that wait for their frame: an estimator may hold the first ones back.
class WaitingScans {
 public:
  void add(const sensors::Measurement& measurement) {
    const auto* scan = std::get_if<ScanPtr>(&measurement);
    if (scan != nullptr) scans_.push_back(*scan);
  }

  /// The scan stamped like the frame; earlier ones will not be asked for again.
  ScanPtr take(geometry::Stamp stamp) {
    while (!scans_.empty() && scans_.front()->stamp < stamp) scans_.pop_front();
    if (scans_.empty() || scans_.front()->stamp != stamp) return nullptr;
    ScanPtr scan = scans_.front();
    scans_.pop_front();
    return scan;
  }

 private:
  std::deque<ScanPtr> scans_;
};

}  // namespace traverse::pipeline
