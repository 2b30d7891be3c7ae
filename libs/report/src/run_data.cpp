#include "run_data.hpp"

#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/evaluation/json.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/pipeline/run_folder.hpp"

namespace traverse::report {

namespace {

nlohmann::json read_record(const std::filesystem::path& file) {
  const std::string text = files::read_text(file);
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::exception& error) {
    throw files::InputError(file, files::Place::whole_file(), "JSON", error.what());
  }
}

evaluation::Evaluation read_evaluation(const std::filesystem::path& file) {
  const std::string text = files::read_text(file);
  try {
    return evaluation::from_json(text);
  } catch (const evaluation::EvaluationError& error) {
    throw files::InputError(file, files::Place::whole_file(), "an evaluation", error.what());
  }
}

/// What `parse` makes of the file, if there is one. `kind` says what it should be.
template <typename Value>
std::optional<Value> read_if_there(const std::filesystem::path& file, const std::string& kind,
                                   Value (*parse)(const std::string&)) {
  if (!std::filesystem::exists(file)) return std::nullopt;
  try {
    return parse(files::read_text(file));
  } catch (const std::runtime_error& error) {
    throw files::InputError(file, files::Place::whole_file(), kind, error.what());
  }
}

}  // namespace

RunData read_run(const std::filesystem::path& folder) {
  const pipeline::RunFolder files{folder};
  RunData run;
  run.folder = folder;
  run.record = read_record(files.record());
  if (run.record.value("status", "") == "failed" && !std::filesystem::exists(files.trajectory())) {
    throw files::InputError(files.record(), files::Place::key("status"), "a run that has results",
                            "failed: " + run.record.value("reason", ""));
  }
  run.frames = pipeline::FrameTable::read_csv(files.frames());
  run.evaluation = read_evaluation(files.evaluation());
  run.estimate = dataset::read_trajectory(files.trajectory(), dataset::TrajectoryFormat::kTum);
  if (std::filesystem::exists(files.reference())) {
    run.reference = dataset::read_trajectory(files.reference(), dataset::TrajectoryFormat::kTum);
  }
  if (std::filesystem::exists(files.loops())) {
    run.odometry = dataset::read_trajectory(files.odometry(), dataset::TrajectoryFormat::kTum);
    run.odometry_evaluation = read_evaluation(files.odometry_evaluation());
    run.loops = slam::read_loops(files.loops());
  }
  if (std::filesystem::exists(files.map_points())) {
    run.map = dataset::read_point_cloud(files.map_points());
  }
  if (std::filesystem::exists(files.sample_scan())) {
    run.sample_scan = dataset::read_point_cloud(files.sample_scan());
  }
  if (std::filesystem::exists(files.worst_frames())) {
    run.worst_frames = dataset::read_point_cloud(files.worst_frames());
  }
  run.jacobians =
      read_if_there(files.jacobians(), "a check of Jacobians", optimization::audit_from_json);
  run.factor_bench = read_if_there(files.factor_bench(), "a measurement of factors",
                                   lidar::factor_bench_from_json);
  return run;
}

}  // namespace traverse::report
