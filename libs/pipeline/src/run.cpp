#include "traverse/pipeline/run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <new>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/dataset/recording_slice.hpp"
#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/evaluation/evaluate.hpp"
#include "traverse/evaluation/json.hpp"
#include "traverse/evaluation/worst_segments.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/digest.hpp"
#include "traverse/mapping/map_origin.hpp"
#include "traverse/optimization/jacobian_audit.hpp"
#include "traverse/pipeline/factor_kinds.hpp"
#include "traverse/plausibility/reference_checks.hpp"
#include "traverse/plausibility/stream_checks.hpp"
#include "traverse/slam/keyframe_file.hpp"
#include "traverse/slam/slam.hpp"

#include "geodetic_path.hpp"
#include "reading_count.hpp"
#include "run_results.hpp"
#include "waiting_scans.hpp"

namespace traverse::pipeline {

namespace {

/// Does one thing after the other. Of what fails the first is kept in mind, and the rest is done
/// all the same: each may be worth having without the others.
class Steps {
 public:
  template <typename Step>
  void operator()(const Step& step) {
    try {
      step();
    } catch (const std::bad_alloc&) {
      note("out of memory: the system gave no more");
    } catch (const std::exception& error) {
      note(error.what());
    }
  }
  void note(const std::string& reason) {
    if (reason_.empty()) reason_ = reason;
  }
  bool has_failed() const { return !reason_.empty(); }
  const std::string& reason() const { return reason_; }

 private:
  std::string reason_;
};

/// Scans read before a run that does not depend on them: a few seconds' work at most.
constexpr std::size_t kMaxSurveyedScans = 60;

bool is_stopped(const RunObserver& observer) { return observer.stop != nullptr && *observer.stop; }

/// Thrown through the reading loop when the user stops the run.
class Stopped : public std::exception {};

/// What contradicts what, as far as it matters to the estimator: of a sensor that it does not
/// depend on a warning is enough.
std::vector<plausibility::Finding> weighed(std::vector<plausibility::Finding> findings,
                                           const dataset::RecordingInfo& recording,
                                           const Estimator& estimator) {
  for (plausibility::Finding& finding : findings) {
    const sensors::MountedSensor* sensor = recording.rig.find(finding.sensor);
    const bool matters = sensor == nullptr || estimator.depends_on(sensor->kind);
    if (!matters) finding.severity = plausibility::Severity::kWarn;
  }
  return findings;
}

/// Of the same contradiction the later figure counts, which is of more of the recording.
void add_if_new(plausibility::Finding finding, std::vector<plausibility::Finding>& findings) {
  for (plausibility::Finding& known : findings) {
    if (known.code != finding.code || known.sensor != finding.sensor) continue;
    known = std::move(finding);
    return;
  }
  findings.push_back(std::move(finding));
}

/// Why a run with these findings would be garbage; empty if it would not.
std::string why_refused(const std::vector<plausibility::Finding>& findings,
                        const std::filesystem::path& recording) {
  std::vector<std::string> lines;
  for (const plausibility::Finding& finding : findings) {
    const bool refuses =
        finding.severity == plausibility::Severity::kRefuse && !finding.is_accepted;
    if (refuses) {
      lines.push_back(fmt::format("\n  {} Or go on all the same: --accept {}",
                                  plausibility::to_text(finding), finding.code));
    }
  }
  if (lines.empty()) return {};
  return fmt::format(
      "{}: the recording contradicts itself, and its result would be worth nothing:{}",
      recording.string(), fmt::join(lines, ""));
}

/// Looks at the beginning of the recording before anything is estimated.
std::vector<plausibility::Finding> survey_beginning(dataset::Source& source,
                                                    const Estimator& estimator) {
  plausibility::SurveyLimits limits;
  // Where other sensors matter they have to move before they can contradict each other.
  if (!estimator.depends_on(sensors::SensorKind::kLidar)) limits.max_scans = kMaxSurveyedScans;
  return weighed(plausibility::survey(source, limits), source.info(), estimator);
}

/// Reads, estimates and collects, to the end or as far as it goes.
void estimate_all(dataset::Source& source, Estimator& estimator, const RunOptions& options,
                  const RunObserver& observer, plausibility::StreamChecks& checks,
                  RunResults& results, ReadingCount& readings, Steps& attempt) {
  WaitingScans waiting;
  std::size_t done = 0;
  // What is estimated from other sensors cannot be held against them.
  const bool is_odometry = estimator.depends_on(sensors::SensorKind::kLidar);
  const auto collect = [&](const std::vector<PoseFrame>& frames) {
    for (const PoseFrame& frame : frames) {
      results.add(frame, waiting.take(frame.stamp), &frame == &frames.back());
      if (is_odometry) checks.take_pose(frame.stamp, frame.T_map_body);
      observer.frame(++done);
    }
  };
  attempt([&] {
    try {
      dataset::for_each_in_slice(source, {"", options.first, options.last},
                                 [&](const sensors::Measurement& measurement) {
                                   if (is_stopped(observer)) throw Stopped();
                                   readings.add(measurement);
                                   waiting.add(measurement);
                                   checks.take(measurement);
                                   collect(estimator.process(measurement));
                                 });
    } catch (const Stopped&) {  // NOLINT(bugprone-empty-catch): what is done is collected below
    }
  });
  attempt([&] { collect(estimator.finish()); });
}

dataset::PointCloud to_point_cloud(const UsedScan& scan) {
  dataset::PointCloud cloud;
  cloud.add("x", scan.x);
  cloud.add("y", scan.y);
  cloud.add("z", scan.z);
  if (!scan.intensity.empty()) cloud.add("intensity", scan.intensity);
  if (!scan.feature_class.empty()) cloud.add("feature_class", scan.feature_class);
  return cloud;
}

evaluation::EvaluationOptions evaluation_options(const dataset::RecordingInfo& recording) {
  evaluation::EvaluationOptions options = evaluation::run_evaluation_options();
  options.kitti.body_frame = recording.rig.body_frame;
  options.kitti.T_body_camera = recording.T_body_camera;
  return options;
}

evaluation::Evaluation evaluate_trajectory(const dataset::Source& source,
                                           const geometry::Trajectory& trajectory,
                                           RunRecord& record) {
  if (const auto& reference = source.reference()) {
    try {
      return evaluation::evaluate(trajectory, reference->T_map_body,
                                  evaluation_options(source.info()));
    } catch (const evaluation::EvaluationError& error) {
      record.evaluation_error = error.what();
    }
  }
  return evaluation::evaluate(trajectory);
}

void write_evaluation(const std::filesystem::path& file, const evaluation::Evaluation& evaluation) {
  files::AtomicFile output(file);
  evaluation::write_json(evaluation, output.stream());
  output.commit();
}

/// What the estimator tells of its sensors, with what the recording gave of each; those that it
/// does not name it does not use.
std::vector<SensorUse> sensor_use(const Estimator& estimator, const sensors::Rig& rig,
                                  const ReadingCount& readings) {
  std::vector<SensorUse> uses = estimator.sensor_use();
  for (SensorUse& use : uses) use.read = readings.of(use.label);
  for (const sensors::MountedSensor& sensor : rig.sensors) {
    const bool is_named = std::any_of(
        uses.begin(), uses.end(), [&](const SensorUse& use) { return use.label == sensor.label; });
    if (is_named) continue;
    SensorUse use{.label = sensor.label, .kind = sensor.kind};
    use.is_taken = false;
    use.read = readings.of(sensor.label);
    use.reason = "this estimator takes none of it";
    uses.push_back(std::move(use));
  }
  return uses;
}

/// What speaks against the run; what the user has accepted does not.
std::vector<Contradiction> against_the_run(const std::vector<plausibility::Finding>& findings) {
  std::vector<Contradiction> list;
  for (const plausibility::Finding& finding : findings) {
    if (finding.is_accepted) continue;
    list.push_back({finding.code, Health::kDegraded,
                    finding.figure + ". " + finding.consequence + ".", finding.statement});
  }
  return list;
}

RunHealth assess_run(const dataset::Source& source, const Estimator& estimator,
                     const RunResults& results, const ReadingCount& readings,
                     const evaluation::Evaluation& evaluation,
                     const std::vector<plausibility::Finding>& contradictions) {
  HealthEvidence evidence{.frames = results.frames(), .T_map_body = results.trajectory()};
  if (source.reference()) evidence.reference = &source.reference()->T_map_body;
  evidence.evaluation = &evaluation;
  evidence.sensors = sensor_use(estimator, source.info().rig, readings);
  evidence.troubles = estimator.troubles();
  evidence.contradictions = against_the_run(contradictions);
  evidence.skipped_records = source.skipped().total();
  evidence.read_records = readings.total();
  evidence.recording_first = readings.first();
  evidence.recording_last = readings.last();
  evidence.is_foreign = estimator.foreign().has_value();
  return assess(evidence);
}

void check_reference(const dataset::Source& source, const geometry::Trajectory& trajectory,
                     RunRecord& record) {
  if (!source.reference()) return;
  auto findings = plausibility::reference_findings(trajectory, source.reference()->T_map_body);
  plausibility::mark_accepted(source.info().accepted_contradictions, findings);
  for (auto& finding : findings) add_if_new(std::move(finding), record.contradictions);
}

/// Accuracy against the reference if there is one, and from it all how far the run can be believed;
/// the sharpness of the map, unless it can not: of points that nothing moves no map is sharper. How
/// the worst frames were registered; accuracy of odometry alone if loops were closed over it.
void evaluate_run(const dataset::Source& source, const Estimator& estimator, RunResults& results,
                  const ReadingCount& readings, const RunFolder& folder, RunRecord& record) {
  evaluation::Evaluation evaluation = evaluate_trajectory(source, results.trajectory(), record);
  const bool is_oriented =
      evaluation.comparison && evaluation.comparison->alignment.determines_rotation();
  if (!record.north_map && is_oriented && source.reference()->north_map) {
    record.north_map = evaluation.comparison->alignment.T_reference_estimate.rotation.transpose() *
                       *source.reference()->north_map;
  }
  record.health =
      assess_run(source, estimator, results, readings, evaluation, record.contradictions);
  const bool is_believable = record.health->verdict != Health::kLost;
  if (is_believable) evaluation.consistency = results.consistency();
  write_evaluation(folder.evaluation(), evaluation);
  const dataset::PointCloud worst_frames = results.worst_frames(
      evaluation::worst_segments(evaluation, results.frames().column("residual_rms_m")));
  if (worst_frames.size() > 0) dataset::write_ply(folder.worst_frames(), worst_frames);
  if (!results.odometry()) return;
  evaluation = evaluate_trajectory(source, *results.odometry(), record);
  if (is_believable) evaluation.consistency = results.odometry_consistency();
  write_evaluation(folder.odometry_evaluation(), evaluation);
}

/// The Jacobians of the factors that the estimator solves with, checked in this very program.
void check_jacobians(const Estimator& estimator, const RunFolder& folder) {
  const auto uses = estimator.factors();
  if (uses.empty()) return;
  const auto kinds = optimization::selected(factor_kinds(), uses);
  const auto audit = optimization::audit_jacobians(kinds, optimization::AuditOptions{});
  files::write_text(folder.jacobians(), optimization::to_json(audit));
}

void fill_results(const RunResults& results, RunRecord& record) {
  record.frames_used = results.frames().rows().size();
  record.sample_frame = results.sample_frame();
  record.map_points = results.map().size();
  record.map_voxel_m = results.map().voxel_m();
  record.keyframes = results.keyframes().size();
  summarise_timing(results.frames(), record);
}

void write_results(const dataset::Source& source, const RunResults& results,
                   const RunFolder& folder, Steps& attempt) {
  attempt([&] { dataset::write_tum(folder.trajectory(), results.trajectory()); });
  attempt([&] { results.frames().write_csv(folder.frames()); });
  attempt([&] {
    if (source.reference()) dataset::write_tum(folder.reference(), source.reference()->T_map_body);
  });
  attempt([&] {
    if (results.odometry()) dataset::write_tum(folder.odometry(), *results.odometry());
  });
  attempt([&] {
    if (results.map().size() > 0) results.map().write_ply(folder.map_points());
  });
  attempt([&] {
    if (results.map().size() > 0) results.keyframes().write(folder.simple_map());
  });
  attempt([&] {
    if (!results.sample().x.empty()) {
      dataset::write_ply(folder.sample_scan(), to_point_cloud(results.sample()));
    }
  });
}

/// What loops have taught: nothing is written where there are none for the frames to go by.
void write_slam(const Estimator& estimator, const RunFolder& folder) {
  const auto slam_map = estimator.slam_map();
  if (!slam_map) return;
  slam::write_loops(folder.loops(), slam_map->slam().loops());
  slam::write_keyframes(folder.keyframes(), slam_map->slam().keyframes(),
                        [&](std::size_t k) { return slam_map->optimised(k); });
}

/// Where on earth the path is, if anything tells.
void write_place(const Estimator& estimator, const RunResults& results, const RunFolder& folder) {
  const auto slam_map = estimator.slam_map();
  const auto origin = slam_map ? slam_map->origin() : estimator.map_origin();
  if (!origin) return;
  mapping::write_map_origin(folder.origin(), *origin);
  write_geodetic_path(results.trajectory(), *origin, folder);
}

RunRecord begin_record(const dataset::Source& source, const Pipeline& pipeline,
                       const RunOptions& options) {
  RunRecord record;
  record.command = options.command;
  record.pipeline = pipeline.name;
  record.pipeline_description = pipeline.description;
  record.estimator_kind = pipeline.estimator_kind;
  record.settings = pipeline.settings;
  record.threads = options.threads;
  record.foreign = pipeline.estimator->foreign();
  record.statements = options.statements;
  record.is_private = options.is_private;
  record.recording = source.info();
  record.first_frame = options.first;
  record.points_are = pipeline.estimator->points_are();
  record.decisions = pipeline.estimator->decisions();
  record.started_utc = utc_now();
  if (const auto& reference = source.reference()) {
    record.reference_file = reference->file.string();
    record.reference_description = reference->description;
  }
  return record;
}

/// Of a run that came to its end.
RunStatus status_by(const std::optional<RunHealth>& health) {
  switch (health ? health->verdict : Health::kOk) {
    case Health::kOk:
      return RunStatus::kOk;
    case Health::kDegraded:
      return RunStatus::kDegraded;
    case Health::kLost:
      return RunStatus::kLost;
  }
  return RunStatus::kLost;
}

}  // namespace

RunRecord run(dataset::Source& source, Pipeline& pipeline, const RunFolder& folder,
              const RunOptions& options, const RunObserver& observer) {
  const auto started = std::chrono::steady_clock::now();
  Estimator& estimator = *pipeline.estimator;
  RunRecord record = begin_record(source, pipeline, options);
  record.place = options.place.empty() ? folder.path : options.place;
  folder.prepare();
  Steps attempt;
  std::optional<RunResults> results;
  ReadingCount readings;
  estimator.spill_to(folder.path);
  attempt([&] { record.contradictions = survey_beginning(source, estimator); });
  if (const std::string why = why_refused(record.contradictions, source.info().path);
      !why.empty()) {
    attempt.note(why);
  } else {
    attempt([&] { results.emplace(estimator, source.info(), options, folder); });
  }
  if (results) {
    plausibility::StreamChecks checks(source.info());
    estimate_all(source, estimator, options, observer, checks, *results, readings, attempt);
    attempt([&] {
      for (auto& finding : weighed(checks.findings(), source.info(), estimator)) {
        add_if_new(std::move(finding), record.contradictions);
      }
    });
  }
  bool stopped = is_stopped(observer);
  attempt([&] {
    record.decisions = estimator.decisions();  // some are made on the way
    record.north_map = estimator.north_map();
  });
  const bool has_frames = results && !results->frames().rows().empty();
  if (has_frames) {
    observer.stage("maps and trajectory");
    attempt([&] { results->correct(); });
    fill_results(*results, record);
    write_results(source, *results, folder, attempt);
    // Without the poses of odometry beside them there was no way to learn from loops.
    if (results->odometry()) attempt([&] { write_slam(estimator, folder); });
    attempt([&] { write_place(estimator, *results, folder); });
    observer.stage("evaluation");
    attempt([&] { check_reference(source, results->trajectory(), record); });
    attempt([&] { evaluate_run(source, estimator, *results, readings, folder, record); });
    attempt([&] { check_jacobians(estimator, folder); });
    if (options.also_write) {
      attempt([&] {
        try {
          options.also_write(results->trajectory(), folder);
        } catch (const evaluation::EvaluationError& error) {
          if (record.evaluation_error.empty()) record.evaluation_error = error.what();
        }
      });
    }
    attempt([&] { add_digests(folder, record.files); });
    stopped = is_stopped(observer);
    if (options.hash_recording && !stopped && !attempt.has_failed()) {
      observer.stage("digest of the recording");
      attempt([&] {
        const files::ContentId id = files::content_id(source.info().path);
        record.recording_bytes = id.bytes;
        record.recording_sha256 = id.sha256;
      });
    }
  } else if (!attempt.has_failed() && !stopped) {
    attempt.note(source.info().path.string() +
                 ": no frame was estimated: the recording has no usable scan in the range asked "
                 "for");
  }
  if (stopped && (!attempt.has_failed() || !has_frames)) {
    record.status = RunStatus::kInterrupted;
    record.reason =
        has_frames ? "stopped by the user" : "stopped by the user before the first frame";
  } else if (attempt.has_failed()) {
    record.status = RunStatus::kFailed;
    record.reason = attempt.reason();
  } else {
    record.status = status_by(record.health);
    if (record.health) record.reason = record.health->summary();
  }
  record.recording = source.info();  // a rawlog's rig is known only after reading
  record.skipped = source.skipped();
  record.frames_read = record.frames_used + record.skipped.total();
  record.peak_memory_mb = peak_memory_mb();
  record.wall_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  write_record(folder, record);
  return record;
}

}  // namespace traverse::pipeline
