#pragma once

#include <optional>
#include <string>
#include <vector>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/evaluation/evaluate.hpp"
#include "traverse/geometry/trajectory.hpp"
#include "traverse/loam/factor_bench.hpp"
#include "traverse/optimization/jacobian_audit.hpp"
#include "traverse/pipeline/frame_table.hpp"
#include "traverse/pipeline/run_folder.hpp"
#include "traverse/pipeline/run_health.hpp"
#include "traverse/slam/loop.hpp"

namespace traverse::pipeline {

/// How much of a run folder a command needs. Each has all that those before it have.
enum class RunPart {
  kFrames,     ///< run.json, frames.csv, trajectory.tum
  kReference,  ///< reference.tum
  kFigures,    ///< the evaluations, odometry.tum and loops.csv
  kAll,        ///< map.ply, scan.ply, worst_frames.ply, jacobians.json, factor_bench.json
};

/// What a run folder holds.
struct RunContents {
  RunFolder folder;
  std::string
      record_json;    ///< run.json: all keys of docs/run-folder.md are there, each of its kind
  RunHealth health;   ///< of run.json; of an older folder, by the files of the part that was read
  FrameTable frames;  ///< one row a pose of the estimate
  geometry::Trajectory estimate;
  std::optional<geometry::Trajectory> reference;

  evaluation::Evaluation evaluation;  ///< of `estimate`; its indices count poses that are there
  /// The odometry that loops were closed over, for a run that closes them, and the candidates.
  std::optional<geometry::Trajectory> odometry;
  std::optional<evaluation::Evaluation> odometry_evaluation;
  std::optional<std::vector<slam::Loop>> loops;

  dataset::PointCloud map;  ///< empty for a run without lidar
  std::optional<dataset::PointCloud> sample_scan;
  std::optional<dataset::PointCloud> worst_frames;
  std::optional<optimization::JacobianAudit> jacobians;
  std::optional<loam::FactorBench> factor_bench;
};

/// Reads the files of `part` and checks them against each other: here, and nowhere else, for every
/// command. What a run does not write always may be absent.
/// \throws files::InputError for a file that is missing, cannot be read, or does not fit the
/// others: with the file, the place in it, what was expected, what was found and what to do; for
/// figures of a run that failed.
RunContents read_run(const RunFolder& folder, RunPart part);

}  // namespace traverse::pipeline
