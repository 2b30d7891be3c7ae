#include "traverse/replay/recording.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"

#include "frame_sensor.hpp"
#include "path_estimator.hpp"

namespace traverse::replay {

namespace {

namespace fs = std::filesystem;

/// What was stated about the recording of a run holds for its replay too. The reference does not:
/// the run has it, and its file may be gone.
void add_statements(const RunFacts& facts, dataset::OpenOptions& options) {
  options.wants_reference =
      std::any_of(options.statements.begin(), options.statements.end(),
                  [](const std::string& stated) { return stated.starts_with("reference."); });
  std::vector<std::string> statements = facts.statements.value_or(std::vector<std::string>());
  const std::vector<std::string>& command = facts.command;
  for (std::size_t i = 0; !facts.statements && i + 1 < command.size(); ++i) {
    if (command[i] == "--recording") statements.push_back(command[i + 1]);
    if (command[i] == "--recording-config") options.statements_file = command[i + 1];
  }
  options.statements.insert(options.statements.begin(), statements.begin(), statements.end());
}

}  // namespace

Recording Recording::open(const fs::path& file_or_run, const dataset::OpenOptions& options,
                          const fs::path& moved_to) {
  Recording recording;
  recording.path_ = file_or_run;
  recording.options_ = options;
  const pipeline::RunFolder folder{file_or_run};
  if (fs::exists(folder.record())) {
    auto contents = std::make_shared<const pipeline::RunContents>(
        pipeline::read_run(folder, pipeline::RunPart::kReference));
    recording.run_ = Run{contents, run_facts(*contents)};
    const RunFacts& facts = recording.run_->facts;
    recording.path_ = moved_to.empty() ? facts.recording : moved_to;
    recording.max_frames_ = facts.first_frame + facts.frames;
    add_statements(facts, recording.options_);
    if (!fs::exists(recording.path_)) {
      throw files::InputError(folder.record(), files::Place::key("recording.path"),
                              "the recording of the run where it was (--moved-to says where it is "
                              "now)",
                              recording.path_.string() + ", which is not there");
    }
  }
  const auto source = recording.source();
  recording.info_ = source->info();
  recording.reference_ = source->reference();
  if (recording.run_ && recording.run_->contents->reference) {
    recording.reference_ =
        dataset::Reference{*recording.run_->contents->reference, folder.reference(), "of the run"};
  }
  recording.frame_sensor_ = replay::frame_sensor(recording.info_.rig);
  return recording;
}

std::unique_ptr<dataset::Source> Recording::source() const {
  return dataset::open_recording(path_, options_);
}

pipeline::Pipeline Recording::make_pipeline(const pipeline::PresetRequest& request,
                                            int threads) const {
  pipeline::Pipeline pipeline;
  if (!has_lidar()) {
    pipeline.name = "recorded path";
    pipeline.description = "the recording's own odometry or satellite fixes";
    pipeline.estimator = std::make_unique<PathEstimator>(frame_sensor_);
    return pipeline;
  }
  if (!run_) {
    const auto preset = pipeline::load_preset(request, options_.share_folder);
    return pipeline::make_pipeline(preset, info_, threads);
  }
  pipeline = pipeline_of_run(*run_, threads);
  pipeline.name += health()->verdict == pipeline::Health::kOk
                       ? " (as run)"
                       : fmt::format(" (as run, {})", name_of(health()->verdict));
  pipeline.estimator = make_run_estimator(*run_->contents, std::move(pipeline.estimator));
  return pipeline;
}

pipeline::Pipeline Recording::pipeline_of_run(const Run& run, int threads) const {
  try {
    const auto preset = preset_of_run(run.facts, options_.share_folder);
    return pipeline::make_pipeline(preset, info_, threads);
  } catch (const files::InputError& error) {
    throw files::InputError(
        run.contents->folder.record(), files::Place::key("configuration"),
        "settings that this program knows",
        std::string(error.what()) + "; `traverse run` again writes the folder anew");
  }
}

}  // namespace traverse::replay
