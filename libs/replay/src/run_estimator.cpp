#include "traverse/replay/run_estimator.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "traverse/files/json_document.hpp"
#include "traverse/pipeline/recording_place.hpp"

namespace traverse::replay {

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

/// What is replayed of a run that was followed in a map are its poses; scans are corrected as its
/// odometry does it, for which the map need not be there.
bool is_of_localization(const std::string& setting) {
  return setting.starts_with("localize.") || setting.starts_with("slam.localize.");
}

/// Files that another program wrote: their poses are in the run folder.
bool is_foreign_file(const std::string& setting) {
  return setting == "poses.file" || setting == "poses.timing";
}

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

/// The odometry of an estimator that followed it in a map ("localize_voxel_map").
std::string odometry_of(const std::string& estimator) {
  constexpr std::string_view kLocalize = "localize_";
  return estimator.starts_with(kLocalize) ? estimator.substr(kLocalize.size()) : estimator;
}

void add_settings(const files::JsonValue& record, RunFacts& facts) {
  const files::JsonValue configuration = record["configuration"];
  const bool is_complete = configuration.has("estimator");
  std::vector<std::string> assignments;
  if (is_complete) {
    assignments = {"estimator=" + odometry_of(configuration["estimator"].text()),
                   "description=" + record["pipeline_description"].json_text()};
  }
  const files::JsonValue settings = configuration["settings"];
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const files::JsonValue setting = settings[i];
    if (!is_complete && !setting["changed"].boolean()) continue;
    // Where in a map the drive was is in its poses: the map itself may have gone elsewhere.
    if (is_of_localization(setting["key"].text())) continue;
    if (is_foreign_file(setting["key"].text())) continue;
    assignments.push_back(setting["key"].text() + "=" + setting["value"].json_text());
  }
  if (is_complete) {
    facts.settings = std::move(assignments);
  } else {
    facts.preset = pipeline::PresetRequest{facts.pipeline, {}, std::move(assignments)};
  }
}

}  // namespace

pipeline::Preset preset_of_run(const RunFacts& facts, const std::filesystem::path& share_folder) {
  if (facts.preset) return pipeline::load_preset(*facts.preset, share_folder);
  pipeline::Preset preset;
  preset.name = facts.pipeline;
  preset.file = "run.json";
  for (config::Document* document : {&preset.as_shipped, &preset.resolved}) {
    for (const std::string& setting : facts.settings) document->set(setting, "run.json");
  }
  return preset;
}

RunFacts run_facts(const pipeline::RunContents& run) {
  const auto document = files::JsonDocument::parse(run.record_json, run.folder.record());
  const files::JsonValue record = document.root();
  RunFacts facts;
  facts.recording = pipeline::find_recording(run.folder, record);
  if (record["recording"].has("statements")) {
    facts.statements = record["recording"]["statements"].texts();
  }
  facts.command = record["command"].texts();
  facts.first_frame = record["frames"]["first"].count();
  facts.frames = run.frames.rows().size();
  facts.pipeline = record["pipeline"].text();
  add_settings(record, facts);
  return facts;
}

std::unique_ptr<pipeline::Estimator> make_run_estimator(
    const pipeline::RunContents& contents, std::unique_ptr<pipeline::Estimator> estimator) {
  const pipeline::FrameTable& table = contents.frames;
  const geometry::Trajectory& trajectory = contents.estimate;
  auto run = std::make_shared<RunFrames>();
  // Frame and stamp come first and the total last, if the times are known: what is between is the
  // estimator's record.
  const bool has_times = table.columns().back() == "total_ms";
  const int totals = has_times ? 1 : 0;
  run->columns.assign(table.columns().begin() + 2, table.columns().end() - totals);
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const std::vector<double>& row = table.rows()[i];
    PoseFrame frame;
    frame.stamp = trajectory.stamp(i);
    frame.T_map_body = trajectory.pose(i);
    frame.record.assign(row.begin() + 2, row.end() - totals);
    frame.milliseconds = has_times ? row.back() : std::numeric_limits<double>::quiet_NaN();
    run->frames.push_back(std::move(frame));
  }
  fill_velocities(run->frames);
  return std::make_unique<RunEstimator>(std::move(run), std::move(estimator));
}

}  // namespace traverse::replay
