#include "slam_estimator.hpp"

#include <chrono>
#include <utility>
#include <variant>

#include <fmt/format.h>

namespace traverse::pipeline {

namespace {

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

}  // namespace

SlamEstimator::SlamEstimator(std::unique_ptr<LidarEstimator> odometry,
                             const slam::SlamOptions& options)
    : odometry_(std::move(odometry)),
      slam_(options, *odometry_->sensor().lidar),
      columns_(odometry_->columns()) {
  columns_.insert(columns_.end(), {"keyframe", "loops", "slam_ms"});
}

SlamEstimator::SlamEstimator(const SlamEstimator& other)
    : odometry_(other.odometry_->copy()),
      slam_(other.slam_),
      columns_(other.columns_),
      waiting_(other.waiting_) {}

std::unique_ptr<Estimator> SlamEstimator::clone() const {
  return std::unique_ptr<Estimator>(new SlamEstimator(*this));
}

std::vector<PoseFrame> SlamEstimator::process(const sensors::Measurement& measurement) {
  const auto* scan = std::get_if<std::shared_ptr<const sensors::LidarScan>>(&measurement);
  if (scan != nullptr && (*scan)->sensor == odometry_->sensor().label) waiting_.push_back(*scan);
  return close_loops(odometry_->process(measurement));
}

std::vector<PoseFrame> SlamEstimator::finish() {
  std::vector<PoseFrame> frames = close_loops(odometry_->finish());
  slam_.finish();
  return frames;
}

std::vector<PoseFrame> SlamEstimator::close_loops(std::vector<PoseFrame> frames) {
  const std::vector<lidar::Frame>& latest = odometry_->latest();
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const auto started = std::chrono::steady_clock::now();
    const std::shared_ptr<const sensors::LidarScan> scan = std::move(waiting_.front());
    waiting_.pop_front();
    const std::size_t loops_before = slam_.loops().size();
    const bool wanted = slam_.wants(latest[k]);
    if (wanted) {
      const auto points = odometry_->odometry().used_scan(*scan, latest[k].velocity, false);
      slam_.add(latest[k], *scan, points, odometry_->odometry().deskew_note() == "on");
    }
    const double milliseconds = milliseconds_since(started);
    frames[k].record.push_back(wanted ? 1 : 0);
    frames[k].record.push_back(static_cast<double>(slam_.loops().size() - loops_before));
    frames[k].record.push_back(milliseconds);
    frames[k].milliseconds += milliseconds;
  }
  return frames;
}

std::vector<Decision> SlamEstimator::decisions() const {
  std::vector<Decision> decisions = odometry_->decisions();
  decisions.push_back(
      {"loops", fmt::format("{} of {} candidates accepted, {} keyframes", slam_.accepted_loops(),
                            slam_.loops().size(), slam_.keyframes().size())});
  return decisions;
}

std::vector<optimization::FactorUse> SlamEstimator::factors() const {
  std::vector<optimization::FactorUse> factors = odometry_->factors();
  const auto of_graph = slam_.graph_factors();
  factors.insert(factors.end(), of_graph.begin(), of_graph.end());
  return factors;
}

}  // namespace traverse::pipeline
