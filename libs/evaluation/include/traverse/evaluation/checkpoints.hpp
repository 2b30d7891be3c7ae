#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "traverse/evaluation/alignment.hpp"
#include "traverse/geometry/stamp.hpp"
#include "traverse/geometry/trajectory.hpp"
#include "traverse/geometry/umeyama.hpp"

namespace traverse::evaluation {

/// A surveyed point that the vehicle was at.
struct Checkpoint {
  std::string name;
  /// When: at a moment, or standing from a moment until another; or else at its n-th stop.
  std::optional<geometry::Stamp> stamp;
  std::optional<geometry::Stamp> until;
  std::size_t stop = 0;     ///< from 1; 0: told by the stamp
  Eigen::Vector3d p_enh;    ///< east, north, height [m]
  Eigen::Vector3d sigma_m;  ///< standard deviations of these; 0: not told
  bool is_control = false;  ///< it takes part in the alignment; others check it
};

/// Reads a table with a header: name; stamp_s, or from_s and to_s, or stop; e_m, n_m, h_m, or
/// latitude_deg, longitude_deg, altitude_m, which become east, north and height at the first point;
/// sigma_m, or sigma_e_m, sigma_n_m, sigma_h_m (east_m, north_m, up_m as the fixes of a receiver
/// are written); use (control or check). Without names (a prism that is followed, a receiver's
/// fixes) points are numbered by their lines; sigmas and use may be absent; without use all are
/// checks. \throws files::InputError naming line, expectation and finding
std::vector<Checkpoint> read_checkpoints(const std::filesystem::path& file);

struct CheckpointOptions {
  /// kNone, kSe3 or kSim3: how the estimate comes to the grid of the points. By the control points
  /// if there are any, else by all; each counts by the inverse of its mean variance.
  AlignmentMode alignment = AlignmentMode::kSe3;
  Eigen::Vector3d p_body = Eigen::Vector3d::Zero();  ///< what stood over the points [m]
  double max_gap_s = 0.5;    ///< poses further apart are not interpolated between
  double time_offset_s = 0;  ///< added to the stamps of the points: of an instrument's own clock
};

struct CheckpointResidual {
  Checkpoint point;
  Eigen::Vector3d estimate_enh;  ///< aligned, metres
  Eigen::Vector3d residual_m;    ///< estimate less survey: dE, dN, dH
};

struct CheckpointFigures {
  std::size_t count = 0;
  Eigen::Vector3d rmse_m = Eigen::Vector3d::Zero();  ///< of dE, dN, dH
  double rmse_horizontal_m = 0;                      ///< root of the mean of dE^2 + dN^2
  double rmse_vertical_m = 0;
  double rmse_3d_m = 0;
  double p95_horizontal_m = 0;  ///< 95th percentiles (type 7) of the lengths
  double p95_vertical_m = 0;
  double survey_horizontal_m = 0;  ///< rms of the survey's own deviations, as far as they are told
  double survey_vertical_m = 0;
  /// Root mean square of the residuals over their deviations, of east and north together and of
  /// height: about 1 where the reference's own uncertainty explains them. Nothing unless all have
  /// deviations.
  std::optional<double> normalised_horizontal;
  std::optional<double> normalised_vertical;
  /// Root of the mean squares by the inverse of the variances: what is known better counts more.
  std::optional<double> weighted_horizontal_m;
  std::optional<double> weighted_vertical_m;
};

struct CheckpointEvaluation {
  AlignmentMode alignment = AlignmentMode::kSe3;
  std::size_t aligned_by = 0;    ///< points
  bool is_by_all = false;        ///< there were no control points: the checks are no checks
  geometry::Similarity enh_map;  ///< from the estimate's map to the grid
  std::vector<CheckpointResidual> residuals;  ///< in the order of the file
  std::optional<CheckpointFigures> control;
  std::optional<CheckpointFigures> check;
  std::vector<std::string> notes;  ///< points that could not be used, and why
};

/// Where a vehicle stood: at least 2 s within 0.1 m, in order of time.
struct Stop {
  geometry::Stamp begin;
  geometry::Stamp end;
};
std::vector<Stop> find_stops(const geometry::Trajectory& T_map_body);

/// Residuals of an estimate at surveyed points.
/// \throws EvaluationError if no point can be used, or they do not determine the alignment
CheckpointEvaluation evaluate_checkpoints(const geometry::Trajectory& T_map_body,
                                          const std::vector<Checkpoint>& points,
                                          const CheckpointOptions& options);

/// As text for people, and as a JSON document.
std::string to_table(const CheckpointEvaluation& evaluation);
std::string to_json(const CheckpointEvaluation& evaluation);

/// What to_json() wrote into a file. \throws files::InputError naming the file and the key
CheckpointEvaluation read_checkpoint_evaluation(const std::filesystem::path& file);

/// Of a run, in its folder.
inline constexpr const char* kCheckpointsFile = "checkpoints.json";

/// "SE(3), by 4 control points", "none: the estimate as it is".
std::string describe_alignment(const CheckpointEvaluation& evaluation);

}  // namespace traverse::evaluation
