#include "recording/listed_source.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "recording/folder_source.hpp"
#include "recording/stamp_sequence.hpp"

namespace traverse::dataset {

namespace {

using Measurements = std::deque<sensors::Measurement>;

class ListedSource final : public Source {
 public:
  ListedSource(RecordingInfo info, Measurements measurements, SkippedRecords skipped,
               std::optional<Reference> reference)
      : info_(std::move(info)),
        reference_(std::move(reference)),
        measurements_(std::move(measurements)),
        skipped_(std::move(skipped)),
        in_order_(measurements_.size()) {
    std::iota(in_order_.begin(), in_order_.end(), std::size_t{0});
    // Numbers of measurements are sorted, which are small: a stable sort takes half as much again.
    std::stable_sort(in_order_.begin(), in_order_.end(), [&](std::size_t a, std::size_t b) {
      return sensors::stamp_of(measurements_[a]) < sensors::stamp_of(measurements_[b]);
    });
  }

  const RecordingInfo& info() const override { return info_; }
  const SkippedRecords& skipped() const override { return skipped_; }
  const std::optional<Reference>& reference() const override { return reference_; }
  std::optional<double> share_read() const override {
    if (in_order_.empty()) return 1;
    return static_cast<double>(next_) / static_cast<double>(in_order_.size());
  }
  std::optional<sensors::Measurement> next() override {
    if (next_ == in_order_.size()) return std::nullopt;
    return measurements_[in_order_[next_++]];
  }
  void rewind() override { next_ = 0; }

 private:
  RecordingInfo info_;
  std::optional<Reference> reference_;
  Measurements measurements_;
  SkippedRecords skipped_;
  std::vector<std::size_t> in_order_;
  std::size_t next_ = 0;
};

/// Of what lines hold: no scans, which are shared.
void set_stamp(sensors::Measurement& measurement, geometry::Stamp stamp) {
  std::visit(
      [&](auto& value) {
        if constexpr (requires { value.stamp; }) value.stamp = stamp;
      },
      measurement);
}

}  // namespace

void ListedRecords::add(sensors::Measurement measurement, std::size_t line) {
  measurements_.push_back(std::move(measurement));
  lines_.push_back(static_cast<std::uint32_t>(line));
}

void ListedRecords::settle(std::vector<Fact>& facts) {
  std::map<std::string, std::vector<std::size_t>> by_sensor;
  for (std::size_t i = 0; i < measurements_.size(); ++i) {
    by_sensor[sensors::sensor_of(measurements_[i])].push_back(i);
  }
  const auto place_of = [&](std::size_t i) { return fmt::format("line {}", lines_[i]); };
  std::vector<SensorStamps> sensors;
  for (const auto& [sensor, numbers] : by_sensor) {
    std::vector<std::optional<geometry::Stamp>> stamps;
    stamps.reserve(numbers.size());
    for (const std::size_t i : numbers) stamps.push_back(sensors::stamp_of(measurements_[i]));
    sensors.push_back(
        {sensor, StampSequence::of(stamps),
         [&place_of, own = &numbers](std::size_t record) { return place_of((*own)[record]); }});
  }
  settle_steps(sensors, facts);

  std::vector<bool> is_kept(measurements_.size(), true);
  auto sensor = sensors.begin();
  for (const auto& [name, numbers] : by_sensor) {
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      const RecordStamp& record = sensor->sequence.records[k];
      if (record.stamp) {
        set_stamp(measurements_[numbers[k]], *record.stamp);
      } else {
        skip(record.fault, place_of(numbers[k]));
        is_kept[numbers[k]] = false;
      }
    }
    ++sensor;
  }
  std::size_t end = 0;
  for (std::size_t i = 0; i < measurements_.size(); ++i) {
    if (is_kept[i] && i != end) measurements_[end] = std::move(measurements_[i]);
    end += is_kept[i] ? 1 : 0;
  }
  measurements_.erase(measurements_.begin() + static_cast<std::ptrdiff_t>(end),
                      measurements_.end());
  lines_.clear();
}

void ListedRecords::skip(const std::string& fault, const std::string& place) {
  if (first_fault_.empty()) first_fault_ = place + ": " + fault;
  skipped_.add(fault, place);
}

bool ListedRecords::has(const std::string& sensor) const {
  return std::any_of(measurements_.begin(), measurements_.end(), [&](const auto& measurement) {
    return sensors::sensor_of(measurement) == sensor;
  });
}

std::unique_ptr<Source> make_listed_source(RecordingInfo info, ListedRecords records,
                                           std::optional<Reference> reference) {
  if (records.stamps_ == ListedRecords::Stamps::kAsRecorded) records.settle(info.facts);
  return std::make_unique<ListedSource>(std::move(info), std::move(records.measurements_),
                                        std::move(records.skipped_), std::move(reference));
}

void take_records(FolderRecording& recording, ListedRecords records) {
  for (sensors::Measurement& measurement : records.measurements_) {
    const geometry::Stamp stamp = sensors::stamp_of(measurement);
    recording.others.push_back({std::move(measurement), stamp, "", ""});
  }
  std::stable_sort(recording.others.begin(), recording.others.end(),
                   [](const SideRecord& a, const SideRecord& b) { return a.stamp < b.stamp; });
  recording.skipped = std::move(records.skipped_);
}

}  // namespace traverse::dataset
