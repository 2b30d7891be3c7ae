#pragma once

#include "traverse/config/binder.hpp"
#include "traverse/geometry/pose3.hpp"
#include "traverse/lidar/frame.hpp"
#include "traverse/loam/association.hpp"
#include "traverse/loam/line_index.hpp"
#include "traverse/loam/registration.hpp"
#include "traverse/loam/sweep_features.hpp"

namespace traverse::loam {

/// How the motion within the sweep that is being registered is undone. (The last sweep is deskewed
/// by its estimated motion, which is known by then.)
enum class SweepMotion {
  kPerPoint,  ///< the solver moves each point by its share s of the motion it looks for (A-LOAM)
  kDeskew,    ///< before each association, by the motion known by then: first the prediction
};

struct ScanToScanOptions {
  SweepMotion sweep_motion = SweepMotion::kPerPoint;
  int steps = 2;                   ///< associations, with a solve each
  double search_radius_m = 5;      ///< a partner in the last scan is nearer than this
  int adjacent_lines = 2;          ///< how many lines away an adjacent scan line may be
  double planar_voxel_m = 0.2;     ///< one planar point of each line a cube of the last scan
  double min_baseline_m = 0.3;     ///< between two points of one scan line that make a plane
  double min_triangle_sine = 0.3;  ///< of the angle between the sides of a plane's triangle

  // In place of the solver's. Two or three single points often make a wrong line or plane, whose
  // pull must end at the range noise; and where there is nothing to see they still make some that
  // seem to stop every motion: a bare tunnel shows an eigenvalue of 0.03 to 0.06 along its axis.
  double huber_m = 0.02;
  double min_eigenvalue = 0.08;
};
void bind(config::Binder& binder, ScanToScanOptions& options);

/// Where a point of the current sweep lies in the last scan: p_last = Exp(s Log R) p + s t for the
/// motion T_last_current = (R, t) between the stamps, `interval_s` apart, and a point measured at
/// the fraction s = (interval + time) / interval of it. LOAM's s, counted from stamp to stamp: the
/// sweep around a stamp has s around 1.
struct SweepClock {
  double interval_s = 0;  ///< 0: all points are at the stamp, s = 1

  double fraction(float time) const {
    return interval_s > 0 ? (interval_s + double{time}) / interval_s : 1;
  }
};

/// For each sharp point the line through the nearest edge point of the last scan and the nearest
/// one on an adjacent scan line; for each flat point the plane through the nearest planar point,
/// another one on its scan line and one on an adjacent line. Points without such partners are left
/// out. The result is in the order of the points for any number of `threads`.
/// Source: LOAM (2014) section V-B, figure 7; A-LOAM, laserOdometry.cpp.
Matches associate_scans(const lidar::TimedPoints& sharp, const lidar::TimedPoints& flat,
                        const LineIndex& last_edges, const LineIndex& last_planar,
                        const geometry::Pose3& T_last_current, const SweepClock& clock,
                        const ScanToScanOptions& options, int threads);

/// What is known of a scan's motion before it is registered.
struct MotionPrediction {
  double interval_s = 0;           ///< since the last scan; 0 if the stamps do not tell
  geometry::Pose3 T_last_current;  ///< between the stamps
  geometry::Twist velocity = geometry::Twist::Zero();  ///< a second, within the sweep, lidar frame
  bool turn_is_measured = false;                       ///< its rotation is an IMU's

  /// The velocity within the sweep when the motion between the stamps is found to be this.
  geometry::Twist velocity_given(const geometry::Pose3& T_last_current) const;
};

/// The motion from the last scan to the current one.
struct ScanMotion {
  geometry::Pose3 T_last_current;  ///< between the stamps
  lidar::RegistrationHealth health;
};

/// Follows the lidar from each scan to the next: the first stage of LOAM.
class ScanToScan {
 public:
  /// \param deskew undo the motion within sweeps
  ScanToScan(const ScanToScanOptions& options, const SolverOptions& solver, bool deskew,
             int threads);

  /// Registers the sweep in the remembered one.
  ScanMotion follow(const SweepFeatures& sweep, const MotionPrediction& prediction,
                    lidar::StageTimes& ms) const;

  /// Makes the sweep the last one. \param velocity estimated body twist a second within it
  void remember(const SweepFeatures& sweep, const geometry::Twist& velocity, lidar::StageTimes& ms);

 private:
  ScanToScanOptions options_;
  SolverOptions solver_;
  bool deskew_;
  int threads_;
  LineIndex last_edges_;
  LineIndex last_planar_;
};

}  // namespace traverse::loam
