#pragma once

#include <filesystem>

namespace traverse::pipeline {

/// The places of a run's files: the contract between `run`, `evaluate`, `report`, `replay`, `batch`
/// and `compare`.
struct RunFolder {
  std::filesystem::path path;

  std::filesystem::path record() const { return path / "run.json"; }
  std::filesystem::path trajectory() const { return path / "trajectory.tum"; }
  /// The same on the UTM grid, if it was asked for.
  std::filesystem::path utm_trajectory() const { return path / "trajectory_utm.tum"; }
  /// The raw poses of the odometry that loops were closed over, and their evaluation.
  std::filesystem::path odometry() const { return path / "odometry.tum"; }
  std::filesystem::path odometry_evaluation() const { return path / "odometry_evaluation.json"; }
  std::filesystem::path loops() const { return path / "loops.csv"; }
  std::filesystem::path keyframes() const { return path / "keyframes.simplemap"; }
  std::filesystem::path reference() const { return path / "reference.tum"; }
  std::filesystem::path frames() const { return path / "frames.csv"; }
  std::filesystem::path map_points() const { return path / "map.ply"; }
  std::filesystem::path simple_map() const { return path / "map.simplemap"; }
  /// Where on earth the map is, if its frame is ENU.
  std::filesystem::path origin() const { return path / "origin.json"; }
  /// One scan of the run with the feature class of each point.
  std::filesystem::path sample_scan() const { return path / "scan.ply"; }
  /// How a frame of each worst segment was registered: its scan and its matches.
  std::filesystem::path worst_frames() const { return path / "worst_frames.ply"; }
  std::filesystem::path evaluation() const { return path / "evaluation.json"; }
  /// The check of the Jacobians of the factors that the run used.
  std::filesystem::path jacobians() const { return path / "jacobians.json"; }
  /// What their derivatives cost, if it was measured.
  std::filesystem::path factor_bench() const { return path / "factor_bench.json"; }
  std::filesystem::path images() const { return path / "images"; }
  std::filesystem::path report() const { return path / "report.html"; }
  std::filesystem::path report_json() const { return path / "report.json"; }

  /// Makes the folder and removes what an earlier run left in these places, so that results never
  /// mix; files of other names stay. \throws files::OutputError if it cannot be written.
  void prepare() const;
};

}  // namespace traverse::pipeline
