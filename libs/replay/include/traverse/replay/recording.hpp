#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "traverse/dataset/open_recording.hpp"
#include "traverse/dataset/source.hpp"
#include "traverse/pipeline/preset.hpp"
#include "traverse/pipeline/registry.hpp"
#include "traverse/pipeline/run_contents.hpp"
#include "traverse/replay/run_estimator.hpp"

namespace traverse::replay {

/// What is replayed: a recording with an estimator, or the folder of a run.
class Recording {
 public:
  /// Opens a recording, or the recording of a run folder (a folder with run.json).
  /// \param moved_to where the recording of a run is now; empty: where it was
  /// \throws files::InputError, also for a run folder whose recording is not there, and as
  /// pipeline::read_run().
  static Recording open(const std::filesystem::path& file_or_run,
                        const dataset::OpenOptions& options,
                        const std::filesystem::path& moved_to = {});

  const dataset::RecordingInfo& info() const { return info_; }
  const std::optional<dataset::Reference>& reference() const { return reference_; }
  const std::string& frame_sensor() const { return frame_sensor_; }
  std::size_t first_frame() const { return run_ ? run_->facts.first_frame : 0; }
  /// Frames there are at most: those of the run, when it is one.
  std::size_t max_frames() const { return max_frames_; }
  bool is_run() const { return run_.has_value(); }
  /// How far the run can be believed; null for a recording.
  const pipeline::RunHealth* health() const { return run_ ? &run_->contents->health : nullptr; }
  bool has_lidar() const { return info_.rig.first(sensors::SensorKind::kLidar) != nullptr; }
  const std::filesystem::path& share_folder() const { return options_.share_folder; }

  /// A reader of its own for each thread. \throws files::InputError
  std::unique_ptr<dataset::Source> source() const;

  /// The estimator that replays: the preset's; of a run folder the run itself; and without a 3-D
  /// lidar the recording's own path.
  /// \throws as pipeline::load_preset() and pipeline::make_pipeline(); of a run files::InputError
  /// that names run.json
  pipeline::Pipeline make_pipeline(const pipeline::PresetRequest& request, int threads) const;

 private:
  struct Run {
    std::shared_ptr<const pipeline::RunContents> contents;  // shared by copies
    RunFacts facts;
  };

  /// The estimator that the run was made with.
  pipeline::Pipeline pipeline_of_run(const Run& run, int threads) const;

  std::filesystem::path path_;
  dataset::OpenOptions options_;
  dataset::RecordingInfo info_;
  std::optional<dataset::Reference> reference_;
  std::string frame_sensor_;
  std::size_t max_frames_ = std::numeric_limits<std::size_t>::max();
  std::optional<Run> run_;
};

}  // namespace traverse::replay
