#pragma once

#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "traverse/dataset/source.hpp"

namespace traverse::testing {

/// A recording that consists of given measurements.
class MadeSource : public dataset::Source {
 public:
  MadeSource(dataset::RecordingInfo info, std::vector<sensors::Measurement> measurements)
      : info_(std::move(info)), measurements_(std::move(measurements)) {}

  const dataset::RecordingInfo& info() const override { return info_; }
  std::optional<sensors::Measurement> next() override {
    if (next_ == fail_at_) throw std::runtime_error("the recording is damaged here");
    if (next_ == measurements_.size()) return std::nullopt;
    return measurements_[next_++];
  }
  void rewind() override { next_ = 0; }
  const dataset::SkippedRecords& skipped() const override { return skipped_; }
  const std::optional<dataset::Reference>& reference() const override { return reference_; }

  dataset::SkippedRecords skipped_;
  std::optional<dataset::Reference> reference_;
  std::optional<std::size_t> fail_at_;  ///< the measurement that cannot be read

 private:
  dataset::RecordingInfo info_;
  std::vector<sensors::Measurement> measurements_;
  std::size_t next_ = 0;
};

}  // namespace traverse::testing
