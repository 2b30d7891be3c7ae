#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "traverse/dataset/source.hpp"

namespace traverse::dataset {

struct FolderRecording;

/// The lines of a recording that is read as a whole. Of a line that is no measurement only the
/// count of its kind is kept, so that memory does not grow with what is of no use.
class ListedRecords {
 public:
  /// Whether the stamps of each sensor are as the lines have them, or grow already.
  enum class Stamps { kAsRecorded, kSettled };
  explicit ListedRecords(Stamps stamps = Stamps::kAsRecorded) : stamps_(stamps) {}

  /// \param line that the measurement stands in
  void add(sensors::Measurement measurement, std::size_t line);
  /// \param place "line 12"
  void skip(const std::string& fault, const std::string& place);

  bool has(const std::string& sensor) const;
  /// "line 12: what is wrong with it" of the first line that was skipped; empty: none was.
  const std::string& first_fault() const { return first_fault_; }

 private:
  friend std::unique_ptr<Source> make_listed_source(RecordingInfo info, ListedRecords records,
                                                    std::optional<Reference> reference);
  friend void take_records(FolderRecording& recording, ListedRecords records);

  /// Makes the stamps of each sensor grow, as the lines stand.
  void settle(std::vector<Fact>& facts);

  std::deque<sensors::Measurement> measurements_;  ///< grows without being copied
  std::deque<std::uint32_t> lines_;                ///< of each
  Stamps stamps_;
  SkippedRecords skipped_;
  std::string first_fault_;
};

/// A recording that consists of `records`, brought into the order of their stamps; what is skipped
/// counts before all else.
std::unique_ptr<Source> make_listed_source(RecordingInfo info, ListedRecords records,
                                           std::optional<Reference> reference);

/// Puts records whose stamps grow already among those beside the scans of a folder.
void take_records(FolderRecording& recording, ListedRecords records);

}  // namespace traverse::dataset
