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
  std::filesystem::path reference() const { return path / "reference.tum"; }
  std::filesystem::path frames() const { return path / "frames.csv"; }
  std::filesystem::path map_points() const { return path / "map.ply"; }
  std::filesystem::path simple_map() const { return path / "map.simplemap"; }
  /// One scan of the run with the feature class of each point.
  std::filesystem::path sample_scan() const { return path / "scan.ply"; }
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
