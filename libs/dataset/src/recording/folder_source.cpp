#include "recording/folder_source.hpp"

#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"

namespace traverse::dataset {

namespace {

using sensors::LidarScan;
using sensors::Measurement;

struct FolderBookmark : Bookmark {
  std::size_t next_scan = 0;
  std::size_t next_other = 0;
  SkippedRecords skipped;
};

class FolderSource : public Source {
 public:
  explicit FolderSource(FolderRecording recording)
      : recording_(std::move(recording)), skipped_(recording_.skipped) {}

  const RecordingInfo& info() const override { return recording_.info; }
  const SkippedRecords& skipped() const override { return skipped_; }
  const std::optional<Reference>& reference() const override { return recording_.reference; }

  std::optional<Measurement> next() override {
    while (next_scan_ < recording_.scans.size() || next_other_ < recording_.others.size()) {
      auto measurement = other_is_next() ? take_other() : take_scan();
      if (measurement) return measurement;
    }
    return std::nullopt;
  }

  void rewind() override {
    next_scan_ = 0;
    next_other_ = 0;
    skipped_ = recording_.skipped;
  }

  std::optional<double> share_read() const override {
    const std::size_t all = recording_.scans.size();
    return all == 0 ? 1.0 : static_cast<double>(next_scan_) / static_cast<double>(all);
  }

  std::shared_ptr<const Bookmark> bookmark() const override {
    auto here = std::make_shared<FolderBookmark>();
    here->next_scan = next_scan_;
    here->next_other = next_other_;
    here->skipped = skipped_;
    return here;
  }

  void return_to(const Bookmark& bookmark) override {
    const auto& there = dynamic_cast<const FolderBookmark&>(bookmark);
    next_scan_ = there.next_scan;
    next_other_ = there.next_other;
    skipped_ = there.skipped;
  }

  std::optional<std::vector<geometry::Stamp>> listed_scan_stamps() const override {
    std::vector<geometry::Stamp> stamps;
    for (const ScanFile& file : recording_.scans) {
      if (file.stamp) stamps.push_back(*file.stamp);
    }
    return stamps;
  }

 private:
  bool other_is_next() const {
    if (next_scan_ == recording_.scans.size()) return true;
    if (next_other_ == recording_.others.size()) return false;
    const auto& scan_stamp = recording_.scans[next_scan_].stamp;
    return scan_stamp && recording_.others[next_other_].stamp < *scan_stamp;
  }

  std::optional<Measurement> take_other() {
    const SideRecord& record = recording_.others[next_other_++];
    if (!record.measurement) {
      skipped_.add(record.fault, record.place);
      return std::nullopt;
    }
    return record.measurement;
  }

  std::optional<Measurement> take_scan() {
    const ScanFile& file = recording_.scans[next_scan_++];
    const std::string place = file.file.lexically_relative(recording_.info.path).generic_string();
    if (!file.stamp) {
      skipped_.add(std::string_view(file.fault) == StampSequence::kNone ? "no stamp for the scan"
                                                                        : file.fault,
                   place);
      return std::nullopt;
    }
    try {
      LidarScan scan = recording_.read(file);
      if (scan.empty()) {
        skipped_.add("scan without points", place);
        return std::nullopt;
      }
      scan.stamp = *file.stamp;
      scan.sensor = recording_.lidar;
      return std::make_shared<const LidarScan>(std::move(scan));
    } catch (const files::InputError& error) {
      skipped_.add("scan cannot be used: expected " + error.expected(),
                   fmt::format("{} (found {})", place, error.found()));
      return std::nullopt;
    }
  }

  FolderRecording recording_;
  std::size_t next_scan_ = 0;
  std::size_t next_other_ = 0;
  SkippedRecords skipped_;
};

}  // namespace

std::unique_ptr<Source> make_folder_source(FolderRecording recording) {
  return std::make_unique<FolderSource>(std::move(recording));
}

}  // namespace traverse::dataset
