#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "traverse/dataset/source.hpp"

namespace traverse::dataset {

/// A line of a recording that is read as a whole: a measurement, or why it is none.
struct ListedRecord {
  std::optional<sensors::Measurement> measurement;
  std::string fault;  ///< empty for a measurement
  std::string place;  ///< "line 12"
};

/// A recording that consists of `records`, brought into the order of their stamps; lines without a
/// measurement count as skipped before all else.
std::unique_ptr<Source> make_listed_source(RecordingInfo info, std::vector<ListedRecord> records,
                                           std::optional<Reference> reference);

}  // namespace traverse::dataset
