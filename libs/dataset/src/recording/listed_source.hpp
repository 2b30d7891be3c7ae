#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "traverse/dataset/source.hpp"

#include "recording/stamp_order.hpp"

namespace traverse::dataset {

/// The lines of a recording that is read as a whole. Of a line that is no measurement only the
/// count of its kind is kept, so that memory does not grow with what is of no use.
class ListedRecords {
 public:
  /// The order of stamps is checked as the lines stand, so that the fault is at the line that steps
  /// back.
  void add(sensors::Measurement measurement, const std::string& place);
  /// \param place "line 12"
  void skip(const std::string& fault, const std::string& place);

  bool has(const std::string& sensor) const;
  /// "line 12: what is wrong with it" of the first line that was skipped; empty: none was.
  const std::string& first_fault() const { return first_fault_; }

 private:
  friend std::unique_ptr<Source> make_listed_source(RecordingInfo info, ListedRecords records,
                                                    std::optional<Reference> reference);

  std::deque<sensors::Measurement> measurements_;  ///< grows without being copied
  StampOrder order_;
  SkippedRecords skipped_;
  std::string first_fault_;
};

/// A recording that consists of `records`, brought into the order of their stamps; lines without a
/// measurement count as skipped before all else.
std::unique_ptr<Source> make_listed_source(RecordingInfo info, ListedRecords records,
                                           std::optional<Reference> reference);

}  // namespace traverse::dataset
