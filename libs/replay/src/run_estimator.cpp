#include "traverse/replay/run_estimator.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/pipeline/frame_table.hpp"

namespace traverse::replay {

using files::InputError;
using files::Place;
using pipeline::PoseFrame;

namespace {

/// What all copies share: the run's frames do not change.
struct RunFrames {
  std::vector<std::string> columns;
  std::vector<PoseFrame> frames;  // stamps ascending
};

class RunEstimator final : public pipeline::Estimator {
 public:
  RunEstimator(std::shared_ptr<const RunFrames> run, std::shared_ptr<const Estimator> estimator)
      : run_(std::move(run)), estimator_(std::move(estimator)) {}

  const std::vector<std::string>& columns() const override { return run_->columns; }

  std::vector<PoseFrame> process(const sensors::Measurement& measurement) override {
    const geometry::Stamp stamp = sensors::stamp_of(measurement);
    const auto found = std::lower_bound(
        run_->frames.begin(), run_->frames.end(), stamp,
        [](const PoseFrame& frame, geometry::Stamp wanted) { return frame.stamp < wanted; });
    const bool is_scan =
        std::holds_alternative<std::shared_ptr<const sensors::LidarScan>>(measurement);
    if (!is_scan || found == run_->frames.end() || found->stamp != stamp) return {};
    return {*found};
  }

  std::vector<PoseFrame> finish() override { return {}; }
  pipeline::UsedScan used_scan(const sensors::LidarScan& scan, const PoseFrame& frame,
                               bool with_classes) const override {
    return estimator_->used_scan(scan, frame, with_classes);
  }
  std::string points_are() const override { return estimator_->points_are(); }
  std::vector<pipeline::Decision> decisions() const override { return estimator_->decisions(); }
  std::unique_ptr<Estimator> clone() const override {
    return std::make_unique<RunEstimator>(*this);
  }

 private:
  std::shared_ptr<const RunFrames> run_;
  std::shared_ptr<const Estimator> estimator_;
};

/// The twist that leads from each frame to the next, which scans were deskewed with but for the
/// last digits: the run folder does not keep it.
void fill_velocities(std::vector<PoseFrame>& frames) {
  for (std::size_t i = 0; i + 1 < frames.size(); ++i) {
    const double dt = geometry::seconds_between(frames[i].stamp, frames[i + 1].stamp);
    if (dt <= 0) continue;
    frames[i].velocity =
        geometry::log_se3(frames[i].T_map_body.inverse() * frames[i + 1].T_map_body) / dt;
    frames[i + 1].velocity = frames[i].velocity;
  }
}

}  // namespace

RunFacts read_run_facts(const pipeline::RunFolder& folder) {
  const std::string text = files::read_text(folder.record());
  try {
    const auto json = nlohmann::json::parse(text);
    RunFacts facts;
    facts.recording = json.at("recording").at("path").get<std::string>();
    facts.command = json.at("command").get<std::vector<std::string>>();
    facts.first_frame = json.at("frames").at("first").get<std::size_t>();
    facts.frames = json.at("frames").at("used").get<std::size_t>();
    facts.preset.name = json.at("pipeline").get<std::string>();
    for (const auto& setting : json.at("configuration").at("settings")) {
      if (!setting.at("changed").get<bool>()) continue;
      facts.preset.assignments.push_back(setting.at("key").get<std::string>() + "=" +
                                         setting.at("value").dump());
    }
    return facts;
  } catch (const nlohmann::json::exception& error) {
    throw InputError(folder.record(), Place::whole_file(), "the record of a run", error.what());
  }
}

std::unique_ptr<pipeline::Estimator> make_run_estimator(
    const pipeline::RunFolder& folder, std::unique_ptr<pipeline::Estimator> estimator) {
  const auto trajectory =
      dataset::read_trajectory(folder.trajectory(), dataset::TrajectoryFormat::kTum);
  const auto table = pipeline::FrameTable::read_csv(folder.frames());
  const bool fits = table.rows().size() == trajectory.size() && table.columns().size() >= 3 &&
                    table.has("frame") && table.has("total_ms");
  if (!fits) {
    throw InputError(folder.frames(), Place::whole_file(),
                     fmt::format("one row for each of the {} poses of trajectory.tum, with frame, "
                                 "stamp_s and total_ms",
                                 trajectory.size()),
                     fmt::format("{} rows", table.rows().size()));
  }
  auto run = std::make_shared<RunFrames>();
  // Frame and stamp come first and the total last: what is between is the estimator's record.
  run->columns.assign(table.columns().begin() + 2, table.columns().end() - 1);
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const std::vector<double>& row = table.rows()[i];
    PoseFrame frame;
    frame.stamp = trajectory.stamp(i);
    frame.T_map_body = trajectory.pose(i);
    frame.record.assign(row.begin() + 2, row.end() - 1);
    frame.milliseconds = row.back();
    run->frames.push_back(std::move(frame));
  }
  fill_velocities(run->frames);
  return std::make_unique<RunEstimator>(std::move(run), std::move(estimator));
}

}  // namespace traverse::replay
