#include "listed_source.hpp"

#include <algorithm>
#include <utility>

#include "stamp_order.hpp"

namespace traverse::dataset {

namespace {

class ListedSource final : public Source {
 public:
  ListedSource(RecordingInfo info, std::vector<ListedRecord> records,
               std::optional<Reference> reference)
      : info_(std::move(info)), reference_(std::move(reference)) {
    // Order is checked as the lines stand, so that the fault is at the line that steps back.
    StampOrder order;
    for (ListedRecord& record : records) {
      if (!record.measurement) {
        skipped_.add(record.fault, record.place);
      } else if (!order.accept(*record.measurement)) {
        skipped_.add(StampOrder::kFault, record.place);
      } else {
        measurements_.push_back(std::move(*record.measurement));
      }
    }
    std::stable_sort(measurements_.begin(), measurements_.end(), [](const auto& a, const auto& b) {
      return sensors::stamp_of(a) < sensors::stamp_of(b);
    });
  }

  const RecordingInfo& info() const override { return info_; }
  const SkippedRecords& skipped() const override { return skipped_; }
  const std::optional<Reference>& reference() const override { return reference_; }
  std::optional<double> share_read() const override {
    if (measurements_.empty()) return 1;
    return static_cast<double>(next_) / static_cast<double>(measurements_.size());
  }
  std::optional<sensors::Measurement> next() override {
    if (next_ == measurements_.size()) return std::nullopt;
    return measurements_[next_++];
  }
  void rewind() override { next_ = 0; }

 private:
  RecordingInfo info_;
  std::optional<Reference> reference_;
  std::vector<sensors::Measurement> measurements_;
  SkippedRecords skipped_;
  std::size_t next_ = 0;
};

}  // namespace

std::unique_ptr<Source> make_listed_source(RecordingInfo info, std::vector<ListedRecord> records,
                                           std::optional<Reference> reference) {
  return std::make_unique<ListedSource>(std::move(info), std::move(records), std::move(reference));
}

}  // namespace traverse::dataset
