#pragma once

#include <cstddef>
#include <string>

#include "traverse/dataset/source.hpp"

#include "progress_bar.hpp"

namespace traverse::app {

/// How far the reading of a recording has come: in scans, and in the share of the file that has
/// been read where the number of scans is not known before.
class RecordingProgress {
 public:
  /// `source` must outlive this.
  RecordingProgress(const std::string& verb, const dataset::Source& source);

  /// To be called with each measurement.
  void update(const sensors::Measurement& measurement);
  void finish() { bar_.finish(); }

 private:
  const dataset::Source& source_;
  std::size_t scans_ = 0;
  ProgressBar bar_;
};

}  // namespace traverse::app
