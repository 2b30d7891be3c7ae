#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

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
  /// The same as LAS, if it was asked for.
  std::filesystem::path las() const { return path / "map.las"; }
  std::filesystem::path simple_map() const { return path / "map.simplemap"; }
  /// Where on earth the map is, if its frame is ENU.
  std::filesystem::path origin() const { return path / "origin.json"; }
  /// The path by latitude, longitude and height, if its frame is ENU: a table, and a line for maps.
  std::filesystem::path geodetic_path() const { return path / "path.csv"; }
  std::filesystem::path geodetic_line() const { return path / "path.kml"; }
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

  /// Where `report` works until its files are complete; gone afterwards.
  std::filesystem::path report_work() const { return path / ".report.traverse-work"; }

  /// All of these files, whether they are there or not, without the pictures in images().
  std::vector<std::filesystem::path> files() const;

  /// Whether a file of this name in images() is one of a run's pictures: "map-height_dark.png".
  static bool is_picture(std::string_view file_name);

  /// Makes the folder. \throws files::OutputError if it cannot be written or something is in it.
  void prepare() const;
};

}  // namespace traverse::pipeline
