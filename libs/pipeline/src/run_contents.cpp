#include "traverse/pipeline/run_contents.hpp"

#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/evaluation/json.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/json_document.hpp"
#include "traverse/files/sealed_json.hpp"
#include "traverse/files/text_file.hpp"

#include "digest_check.hpp"
#include "evaluation_check.hpp"
#include "frames_check.hpp"
#include "next_step.hpp"
#include "points_check.hpp"
#include "record_check.hpp"
#include "run_health_json.hpp"

namespace traverse::pipeline {

namespace {

using files::InputError;
using files::Place;
namespace fs = std::filesystem;

constexpr double kFarthest_m = 1e9;  // from the origin of the map: nothing drives there

geometry::Trajectory read_path(const fs::path& file) {
  geometry::Trajectory path = dataset::read_trajectory(file, dataset::TrajectoryFormat::kTum);
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path.pose(i).translation.cwiseAbs().maxCoeff() <= kFarthest_m) continue;
    throw InputError(file, {fmt::format("pose {}", i)},
                     fmt::format("positions within {:.0e} m", kFarthest_m), "one farther off");
  }
  return path;
}

void require_odometry(const RunContents& run) {
  if (run.odometry->stamps() == run.estimate.stamps()) return;
  throw InputError(run.folder.odometry(), Place::whole_file(),
                   fmt::format("{} poses with the stamps of trajectory.tum", run.estimate.size()),
                   run.odometry->size() == run.estimate.size()
                       ? "other stamps"
                       : fmt::format("{} poses", run.odometry->size()));
}

/// The stamps of the frames that became keyframes, if the run says which ones did.
std::optional<std::vector<geometry::Stamp>> keyframe_stamps(const RunContents& run) {
  if (!run.frames.has("keyframe")) return std::nullopt;
  const std::vector<double> is_keyframe = run.frames.column("keyframe");
  std::vector<geometry::Stamp> stamps;
  for (std::size_t i = 0; i < is_keyframe.size(); ++i) {
    if (is_keyframe[i] != 0) stamps.push_back(run.estimate.stamp(i));
  }
  return stamps;
}

void require_loops(const RunContents& run) {
  const auto stamps = keyframe_stamps(run);
  const std::vector<slam::Loop>& loops = *run.loops;
  for (std::size_t k = 0; k < loops.size(); ++k) {
    const slam::Loop& loop = loops[k];
    const auto fail = [&](const std::string& expected, const std::string& found) {
      throw InputError(run.folder.loops(), {fmt::format("loop {}", k)}, expected, found);
    };
    if (loop.candidate >= loop.keyframe) {
      fail("a candidate before its keyframe",
           fmt::format("{} and {}", loop.candidate, loop.keyframe));
    }
    for (const double value : {loop.overlap, loop.residual_rms_m, loop.odometry_chi2,
                               loop.graph_chi2, loop.weight, loop.correction_m}) {
      if (std::isnan(value)) fail("numbers", "nan");
    }
    if (!stamps) continue;
    if (loop.keyframe >= stamps->size()) {
      fail(fmt::format("one of the {} keyframes of frames.csv", stamps->size()),
           fmt::format("number {}", loop.keyframe));
    }
    if (loop.stamp != (*stamps)[loop.keyframe] ||
        loop.candidate_stamp != (*stamps)[loop.candidate]) {
      fail(fmt::format("the stamps of keyframes {} and {} in trajectory.tum", loop.candidate,
                       loop.keyframe),
           fmt::format("{} and {}", to_text(loop.candidate_stamp), to_text(loop.stamp)));
    }
  }
}

/// Reads run.json, frames.csv and trajectory.tum. \returns what the other files are held against
DigestCheck read_frame_files(RunContents& run, RunPart part) {
  run.record_json = files::read_text(run.folder.record());
  DigestCheck digests(run.folder, run.record_json);
  const auto document = files::JsonDocument::parse(run.record_json, run.folder.record());
  const files::JsonValue record = document.root();
  require_run_record(record);
  // Before anything is looked for that a failed run need not have.
  if (part >= RunPart::kFigures && record["status"].text() == "failed" &&
      !fs::exists(run.folder.trajectory())) {
    throw record["status"].error("a run that has results", "failed: " + record["reason"].text());
  }
  digests.require(run.folder.trajectory());
  digests.require(run.folder.frames());
  run.estimate = read_path(run.folder.trajectory());
  run.frames = FrameTable::read_csv(run.folder.frames());
  require_frames(run.frames, run.estimate, record, run.folder);
  return digests;
}

void read_figure_files(RunContents& run, const DigestCheck& digests) {
  const RunFolder& folder = run.folder;
  for (const fs::path& file :
       {folder.evaluation(), folder.loops(), folder.odometry(), folder.odometry_evaluation()}) {
    digests.require(file);
  }
  run.evaluation = evaluation::read_evaluation(folder.evaluation());
  require_evaluation(run.evaluation, folder.evaluation(), run.estimate, folder.trajectory(),
                     run.reference);
  if (!fs::exists(folder.loops())) return;
  run.odometry = read_path(folder.odometry());
  require_odometry(run);
  run.odometry_evaluation = evaluation::read_evaluation(folder.odometry_evaluation());
  require_evaluation(*run.odometry_evaluation, folder.odometry_evaluation(), *run.odometry,
                     folder.odometry(), run.reference);
  run.loops = slam::read_loops(folder.loops());
  require_loops(run);
}

/// The assessment of run.json; of a folder from before there were any, by what was read of it.
RunHealth health_of(const RunContents& run) {
  const auto document = files::JsonDocument::parse(run.record_json, run.folder.record());
  const files::JsonValue record = document.root();
  if (has_health(record)) return health_from_json(record["health"]);
  HealthEvidence evidence{.frames = run.frames, .T_map_body = run.estimate};
  if (run.reference) evidence.reference = &*run.reference;
  if (run.evaluation.comparison) evidence.evaluation = &run.evaluation;
  const files::JsonValue skipped = record["frames"]["skipped"];
  for (const std::string& reason : skipped.keys()) {
    evidence.skipped_records += skipped[reason].count();
  }
  evidence.read_records = run.frames.rows().size();
  return assess(evidence);
}

/// The cloud of the file, if there is one, with x, y and z.
std::optional<dataset::PointCloud> read_points(const fs::path& file) {
  if (!fs::exists(file)) return std::nullopt;
  dataset::PointCloud cloud = dataset::read_point_cloud(file);
  for (const char* axis : {"x", "y", "z"}) {
    require_values(cloud, file, axis, -kFarthest_m, kFarthest_m, IsWhole::kNo);
  }
  return cloud;
}

/// A run leaves no file of nothing.
void require_points(const dataset::PointCloud& cloud, const fs::path& file) {
  if (cloud.size() == 0) throw InputError(file, Place::whole_file(), "at least one point", "none");
}

/// What the derivatives cost: measured on a frame of the run's recording, when it was made or
/// later.
loam::FactorBench read_factor_bench(const fs::path& file, const files::JsonValue& record) {
  const std::string text = files::read_text(file);
  files::require_seal(text, file);
  const auto document = files::JsonDocument::parse(text, file);
  loam::FactorBench bench = loam::factor_bench_from_json(document.root());
  const std::string recording = record["recording"]["name"].text();
  if (bench.recording != recording) {
    throw document.root()["recording"].error("the recording of the run, " +
                                             files::in_quotes(recording));
  }
  return bench;
}

void read_other_files(RunContents& run, const DigestCheck& digests) {
  const RunFolder& folder = run.folder;
  for (const fs::path& file :
       {folder.map_points(), folder.sample_scan(), folder.worst_frames(), folder.jacobians()}) {
    digests.require(file);
  }
  const files::JsonDocument record = files::JsonDocument::parse(run.record_json, folder.record());
  if (auto map = read_points(folder.map_points())) {
    require_size(*map, folder.map_points(), record.root()["map"]["points"].count());
    require_values_if_there(*map, folder.map_points(), "intensity", -kFarthest_m, kFarthest_m,
                            IsWhole::kNo);
    run.map = std::move(*map);
  }
  run.sample_scan = read_points(folder.sample_scan());
  if (run.sample_scan) {
    require_points(*run.sample_scan, folder.sample_scan());
    require_values_if_there(*run.sample_scan, folder.sample_scan(), "feature_class", 0, 4,
                            IsWhole::kYes);
  }
  run.worst_frames = read_points(folder.worst_frames());
  if (run.worst_frames) {
    require_points(*run.worst_frames, folder.worst_frames());
    require_worst_frames(*run.worst_frames, folder, run.frames);
  }
  if (fs::exists(folder.jacobians())) {
    run.jacobians =
        optimization::audit_from_json(files::JsonDocument::read(folder.jacobians()).root());
  }
  if (fs::exists(folder.factor_bench())) {
    run.factor_bench = read_factor_bench(folder.factor_bench(), record.root());
  }
}

}  // namespace

RunContents read_run(const RunFolder& folder, RunPart part) {
  return with_next_step([&] {
    RunContents run;
    run.folder = folder;
    const DigestCheck digests = read_frame_files(run, part);
    if (part >= RunPart::kReference && fs::exists(folder.reference())) {
      digests.require(folder.reference());
      run.reference = read_path(folder.reference());
    }
    if (part >= RunPart::kFigures) read_figure_files(run, digests);
    run.health = health_of(run);
    if (part >= RunPart::kAll) read_other_files(run, digests);
    return run;
  });
}

}  // namespace traverse::pipeline
