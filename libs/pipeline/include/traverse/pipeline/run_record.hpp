#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "traverse/dataset/source.hpp"
#include "traverse/pipeline/estimator.hpp"
#include "traverse/pipeline/imported_poses.hpp"
#include "traverse/pipeline/provenance.hpp"
#include "traverse/pipeline/registry.hpp"
#include "traverse/pipeline/run_digests.hpp"
#include "traverse/pipeline/run_health.hpp"
#include "traverse/plausibility/finding.hpp"

namespace traverse::pipeline {

/// How a run ended. One that came to its end is ok, degraded or lost by its assessment
/// (RunHealth); all three are complete.
enum class RunStatus { kOk, kDegraded, kLost, kFailed, kInterrupted };

/// Whether it came to its end, however good it is.
constexpr bool is_complete(RunStatus status) {
  return status == RunStatus::kOk || status == RunStatus::kDegraded || status == RunStatus::kLost;
}

/// Milliseconds of one stage over the frames.
struct StageTiming {
  std::string name;  ///< of the column without "_ms"
  double median = 0;
  double mean = 0;
  double p95 = 0;
  double max = 0;
};

/// Everything about a run but its results: run.json.
struct RunRecord {
  RunStatus status = RunStatus::kFailed;
  std::string reason;               ///< why it is not ok
  std::optional<RunHealth> health;  ///< nothing without a frame

  std::vector<std::string> command;
  std::filesystem::path place;  ///< where the folder will stand, absolute; empty: not known
  bool is_private = false;      ///< absolute paths and the host are left out of run.json
  std::string pipeline;
  std::string pipeline_description;
  std::string estimator_kind;  ///< "voxel_map", "localize_voxel_map"
  std::vector<ResolvedSetting> settings;
  int threads = 1;
  /// Of poses that another program made: what is known of its run, in place of the threads, times
  /// and memory of this one.
  std::optional<ForeignTiming> foreign;

  dataset::RecordingInfo recording;
  std::vector<std::string> statements;  ///< about it, beyond what stands beside it
  std::uintmax_t recording_bytes = 0;
  std::string recording_sha256;  ///< empty if it was not asked for
  std::optional<std::string> reference_file;
  std::string reference_description;
  std::string points_are;  ///< what was done to the points that were used
  std::vector<Decision> decisions;

  std::size_t frames_read = 0;
  std::size_t frames_used = 0;
  std::size_t first_frame = 0;
  std::size_t sample_frame = 0;  ///< the frame of scan.ply, counted like first_frame
  dataset::SkippedRecords skipped;
  /// What contradicts what; of severity kRefuse only where the estimator depends on the sensor.
  std::vector<plausibility::Finding> contradictions;

  double frame_median_ms = 0;
  double frame_p95_ms = 0;
  double frame_max_ms = 0;
  double frames_total_ms = 0;
  std::vector<StageTiming> stages;

  std::size_t map_points = 0;
  double map_voxel_m = 0;
  std::optional<Eigen::Vector3d> north_map;  ///< unit vector to true north, where it is known
  std::size_t keyframes = 0;

  std::string evaluation_error;  ///< why there is no comparison although there is a reference

  std::vector<FileDigest> files;  ///< of the run folder, as the run wrote them

  std::string started_utc;
  double wall_seconds = 0;
  double peak_memory_mb = 0;
};

/// Fills the timing figures from a frame table with columns "..._ms" and "total_ms".
class FrameTable;
void summarise_timing(const FrameTable& frames, RunRecord& record);

/// The record as JSON text; docs/run-folder.md describes it.
std::string to_json(const RunRecord& record, const BuildInfo& build, const HostInfo& host);

/// Writes run.json as this program on this machine, with its own digest. \throws files::OutputError
struct RunFolder;
void write_record(const RunFolder& folder, const RunRecord& record);

/// SHA-256 of the resolved settings as they stand in run.json: equal for equal configurations.
std::string configuration_sha256(const std::vector<ResolvedSetting>& settings);

}  // namespace traverse::pipeline
