#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "traverse/evaluation/evaluate.hpp"
#include "traverse/geometry/stamp.hpp"
#include "traverse/geometry/trajectory.hpp"
#include "traverse/pipeline/frame_table.hpp"
#include "traverse/pipeline/health_reason.hpp"
#include "traverse/pipeline/sensor_use.hpp"

namespace traverse::pipeline {

/// Frames in a row of which the same is true.
struct Spell {
  std::size_t frames = 0;
  std::size_t first_frame = 0;  ///< number of the first, as in frames.csv
  double begin_s = 0;           ///< from the first pose to it
  double seconds = 0;           ///< from the last frame before them to the first after them
};

struct Spells {
  std::size_t frames = 0;  ///< in all of them
  std::size_t count = 0;
  Spell longest;  ///< by time
};

/// Stretches of time without a pose.
struct Gaps {
  std::size_t count = 0;  ///< of more than 1.5 usual intervals
  double usual_s = 0;     ///< the median interval between frames
  double longest_s = 0;
  std::size_t after_frame = 0;  ///< the longest begins there
};

/// Steps of the path that no vehicle makes.
struct Leaps {
  std::size_t count = 0;
  double largest_m = 0;  ///< beyond where the motion before it led
  double seconds = 0;    ///< in which that one happened
  std::size_t frame = 0;
};

/// Something in the recording that contradicts itself, another sensor or the estimate.
struct Contradiction {
  std::string code;
  Health severity = Health::kDegraded;
  std::string text;       ///< a sentence with its figure and its consequence
  std::string statement;  ///< option that mends it, "--recording imu.unit=g"; empty: none does
};

/// The assessment of a run: run.json, "health".
struct RunHealth {
  Health verdict = Health::kOk;
  std::vector<HealthReason> reasons;  ///< the most severe first; none if ok

  bool is_navigation = false;  ///< by fixes, wheels and the IMU, not by scans
  /// Another program made the poses: how it found them, registrable to restarts below, is not
  /// known.
  bool is_foreign = false;
  std::size_t frames = 0;
  /// Frames whose pose could rest on a measurement of where the vehicle is: all but the first, and
  /// but those in an outage that was asked for.
  std::size_t registrable = 0;
  /// Those of them whose pose does: a scan that was registered, an accepted fix or wheel reading.
  std::size_t registered = 0;
  std::optional<std::size_t> located;  ///< frames whose place in a given map is known
  Spells lost;                         ///< registrable frames that were not registered
  Spells degenerate;                   ///< registered, but not in every direction of motion
  /// Degenerate frames for which a prediction does not hold any more: more than a second after the
  /// last that was determined, or for as long before any was.
  std::size_t unsupported = 0;
  std::size_t restarts = 0;                  ///< the estimator gave up what it knew and began again
  std::optional<double> first_pose_after_s;  ///< from the first measurement of the recording
  std::optional<double> first_pose_share;    ///< the same, of the recording's time
  std::optional<double> covered_share;       ///< of the recording's time, from first to last pose
  Gaps gaps;
  Leaps leaps;
  std::size_t skipped_records = 0;
  double skipped_share = 0;  ///< of the records that were read
  /// Root mean square of the absolute errors over that of the reference's distances from its
  /// centre: by how much of the drive the estimate and its reference differ.
  std::optional<double> error_share;
  std::vector<SensorUse> sensors;
  std::vector<Contradiction> contradictions;

  /// Nothing where no frame could be registered.
  std::optional<double> registered_share() const;
  std::optional<double> located_share() const;
  /// The texts of the reasons of the worst severity, one after the other.
  std::string summary() const;
};

/// What a run is assessed by.
struct HealthEvidence {
  const FrameTable& frames;
  const geometry::Trajectory& T_map_body;  ///< the final poses, one for each of `frames`
  const geometry::Trajectory* reference = nullptr;
  const evaluation::Evaluation* evaluation = nullptr;
  std::vector<SensorUse> sensors = {};
  std::vector<HealthReason> troubles = {};  ///< that the estimator tells itself
  std::size_t skipped_records = 0;
  std::size_t read_records = 0;  ///< that were usable
  std::optional<geometry::Stamp> recording_first = {};
  std::optional<geometry::Stamp> recording_last = {};
  std::vector<Contradiction> contradictions = {};
  bool is_foreign = false;  ///< another program made the poses
};

/// The assessment, for every kind of estimator alike, by the estimator's own record and by what
/// contradicts it. A pure function. docs/run-folder.md lists the limits and their reasons.
RunHealth assess(const HealthEvidence& evidence);

}  // namespace traverse::pipeline
