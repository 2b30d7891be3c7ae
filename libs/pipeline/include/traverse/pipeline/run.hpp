#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "traverse/dataset/source.hpp"
#include "traverse/geometry/trajectory.hpp"
#include "traverse/pipeline/registry.hpp"
#include "traverse/pipeline/run_folder.hpp"
#include "traverse/pipeline/run_record.hpp"

namespace traverse::pipeline {

struct RunOptions {
  std::size_t first = 0;  ///< frames are counted from 0, both ends are included
  std::size_t last = std::numeric_limits<std::size_t>::max();
  int threads = 1;
  bool hash_recording = true;
  double map_voxel_m = 0.2;
  std::size_t max_map_points = 20'000'000;
  std::vector<std::string> command;  ///< for the record
  /// What was stated about the recording, to hold from any folder: dataset::lasting_statements().
  std::vector<std::string> statements;
  std::filesystem::path place;  ///< where the folder will stand in the end; empty: where it is
  /// What else is written of the estimate, before the files' digests are taken; it may throw.
  std::function<void(const geometry::Trajectory& T_map_body, const RunFolder& folder)> also_write =
      {};
  bool is_private = false;  ///< the record tells neither whose machine it was nor its paths
};

/// What a run tells while it works.
struct RunObserver {
  /// A frame is done; `done` of all frames so far.
  std::function<void(std::size_t done)> frame = [](std::size_t) {};
  /// The frames are through; what follows takes time too: "map", "evaluation".
  std::function<void(const std::string& stage)> stage = [](const std::string&) {};
  /// Once it is true the run ends after the present frame and writes what it has.
  const std::atomic<bool>* stop = nullptr;
};

/// Feeds the recording to the pipeline's estimator and writes the run folder: trajectory,
/// reference, frames.csv, maps, a sample scan, evaluation.json and, last, run.json.
///
/// A run that is stopped or fails in the middle (the recording cannot be read on, the estimator
/// gives up, memory or disk are full) writes what was estimated before, as far as that can be done.
/// \param folder absent or empty
/// \returns the record that was written, whose status and reason say how it went. Without a frame
/// (`frames_used`) there is nothing but that record.
/// \throws files::OutputError if the folder cannot be made, or not even run.json be written
[[nodiscard]] RunRecord run(dataset::Source& source, Pipeline& pipeline, const RunFolder& folder,
                            const RunOptions& options, const RunObserver& observer);

}  // namespace traverse::pipeline
