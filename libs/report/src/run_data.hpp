#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/evaluation/evaluate.hpp"
#include "traverse/evaluation/worst_segments.hpp"
#include "traverse/geometry/trajectory.hpp"
#include "traverse/loam/factor_bench.hpp"
#include "traverse/optimization/jacobian_audit.hpp"
#include "traverse/pipeline/frame_table.hpp"
#include "traverse/slam/loop.hpp"

namespace traverse::report {

/// A run folder, read.
struct RunData {
  std::filesystem::path folder;
  nlohmann::json record;  ///< run.json
  pipeline::FrameTable frames;
  evaluation::Evaluation evaluation;
  geometry::Trajectory estimate;
  /// The odometry that loops were closed over, for a run that closes them, and the candidates.
  std::optional<geometry::Trajectory> odometry;
  std::optional<evaluation::Evaluation> odometry_evaluation;
  std::optional<std::vector<slam::Loop>> loops;
  std::optional<geometry::Trajectory> reference;
  dataset::PointCloud map;  ///< empty for a run without lidar
  std::optional<dataset::PointCloud> sample_scan;
  std::optional<dataset::PointCloud> worst_frames;
  std::optional<optimization::JacobianAudit> jacobians;
  std::optional<loam::FactorBench> factor_bench;

  std::string recording_name() const { return record.at("recording").at("name"); }
  std::string pipeline_name() const { return record.at("pipeline"); }
  std::string date() const { return std::string(record.at("started_utc")).substr(0, 10); }
};

/// \throws files::InputError if a file is missing or is not what it should be.
RunData read_run(const std::filesystem::path& folder);

}  // namespace traverse::report
