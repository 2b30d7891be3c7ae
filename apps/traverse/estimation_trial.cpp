#include "estimation_trial.hpp"

#include <algorithm>
#include <exception>
#include <utility>

namespace traverse::app {

namespace {

std::vector<std::string> columns_of(const pipeline::Estimator& estimator) {
  std::vector<std::string> columns{"frame", "stamp_s"};
  columns.insert(columns.end(), estimator.columns().begin(), estimator.columns().end());
  return columns;
}

}  // namespace

EstimationTrial::EstimationTrial(std::unique_ptr<pipeline::Estimator> estimator)
    : estimator_(std::move(estimator)), table_(columns_of(*estimator_)) {}

template <typename Work>
std::vector<pipeline::PoseFrame> EstimationTrial::attempt(const Work& work) {
  if (has_failed_) return {};
  try {
    std::vector<pipeline::PoseFrame> frames = work();
    for (const pipeline::PoseFrame& frame : frames) {
      std::vector<double> row{static_cast<double>(T_map_body_.size()), frame.stamp.seconds()};
      row.insert(row.end(), frame.record.begin(), frame.record.end());
      table_.add_row(std::move(row));
      T_map_body_.push_back(frame.stamp, frame.T_map_body);
    }
    return frames;
  } catch (const std::exception&) {
    has_failed_ = true;  // a run says why; what is in the recording is told all the same
    return {};
  }
}

std::vector<pipeline::PoseFrame> EstimationTrial::take(const sensors::Measurement& measurement) {
  ++readings_[sensors::sensor_of(measurement)];
  const geometry::Stamp stamp = sensors::stamp_of(measurement);
  first_ = first_ ? std::min(*first_, stamp) : stamp;
  last_ = last_ ? std::max(*last_, stamp) : stamp;
  return attempt([&] { return estimator_->process(measurement); });
}

std::vector<pipeline::PoseFrame> EstimationTrial::finish() {
  return attempt([&] { return estimator_->finish(); });
}

double EstimationTrial::seconds() const {
  return first_ ? geometry::seconds_between(*first_, *last_) : 0;
}

std::optional<pipeline::RunHealth> EstimationTrial::health() const {
  if (has_failed_ || T_map_body_.empty()) return std::nullopt;
  pipeline::HealthEvidence evidence{.frames = table_, .T_map_body = T_map_body_};
  evidence.sensors = estimator_->sensor_use();
  for (pipeline::SensorUse& use : evidence.sensors) {
    const auto read = readings_.find(use.label);
    if (read != readings_.end()) use.read = read->second;
  }
  evidence.troubles = estimator_->troubles();
  evidence.recording_first = first_;
  evidence.recording_last = last_;
  return pipeline::assess(evidence);
}

}  // namespace traverse::app
