#include "traverse/evaluation/evaluate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/evaluation/checkpoints.hpp"
#include "traverse/evaluation/json.hpp"
#include "traverse/evaluation/table.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/json_document.hpp"
#include "traverse/files/numbers.hpp"
#include "traverse/pipeline/run_digests.hpp"
#include "traverse/pipeline/run_folder.hpp"
#include "traverse/report/evaluation_pictures.hpp"

#include "budget_option.hpp"
#include "commands.hpp"
#include "json_output.hpp"

namespace traverse::app {

namespace {

namespace fs = std::filesystem;
using dataset::TrajectoryFormat;
using evaluation::AlignmentMode;
using evaluation::Relation;

constexpr const char* kEvaluateExamples = R"(Examples:
  traverse evaluate estimate.tum --reference reference.tum --align se3
  traverse evaluate RUN --rpe 10f --rpe 100m --all-pairs --json evaluation.json
  traverse evaluate 00_estimate.txt --reference 00.txt --format kitti --align sim3 --relation full
  traverse evaluate out.bag --topic /odometry --reference truth.csv --from 1700000010 --to 1700000070
  traverse evaluate estimate.tum --reference reference.tum --align se3 --plot pictures
  traverse evaluate RUN --checkpoints points.csv --point 0.3,0,1.2

ESTIMATE and REFERENCE are TUM, KITTI, EuRoC or CSV files, g2o or bags; KITTI files go by index, others by time: each
pose of the shorter file gets the pose of the other that is nearest in time, the earlier of two, if
it is within --max-time-difference. Times are compared as evo does, as doubles of seconds: at Unix
times they are 0.24 us apart, and that decides between two poses that are equally near. Positions on
a line, or that stand still, leave a rotation of the alignment open: then the errors of position are
shown, those of rotation only after alignment at the first pose. The definitions are
those of evo: translation is its trans_part, rotation its rot_part, point-distance-ratio its
point_distance_error_ratio; relative errors by length those of rpg_trajectory_evaluation. Without --relation the table shows translation and angle-deg, without
--rpe the error over one frame. KITTI drift and path figures are of the estimate as it is, not
aligned. Of trajectories of more than 65,536 poses what does not fit lies in a file without a name
in $TMPDIR or /tmp, 96 bytes a pose, until the program ends.)";

struct EvaluateArguments {
  fs::path estimate;
  std::optional<fs::path> reference;
  dataset::TrajectoryChoice choice;  ///< of the estimate; its format is that of both files
  std::optional<TrajectoryFormat> reference_format;
  std::string reference_topic;
  std::string reference_columns;
  std::optional<double> from_s;  ///< poses before are left out, of both files
  std::optional<double> to_s;    ///< and those after
  std::optional<fs::path> checkpoints;
  std::vector<double> point;  ///< what stood over them, body frame; empty: the body's origin
  bool has_alignment = false;
  evaluation::EvaluationOptions options;
  std::vector<std::string> relations;
  std::vector<std::string> deltas;
  bool all_pairs = false;
  evaluation::PairsFrom pairs_from = evaluation::PairsFrom::kEstimate;
  std::optional<fs::path> plot;  ///< folder for pictures
  std::optional<fs::path> json;
  std::optional<fs::path> budget;
};

template <typename Enum, std::size_t N>
using Names = std::array<std::pair<std::string_view, Enum>, N>;

template <typename Enum, std::size_t N>
Enum named(const Names<Enum, N>& names, std::string_view name) {
  return std::find_if(names.begin(), names.end(),
                      [&](const auto& entry) { return entry.first == name; })
      ->second;
}

template <typename Enum, std::size_t N>
CLI::IsMember one_of(const Names<Enum, N>& names) {
  std::vector<std::string> allowed;
  for (const auto& entry : names) allowed.emplace_back(entry.first);
  return CLI::IsMember(allowed);
}

/// An option that takes one of `names` and puts its meaning into `value`.
template <typename Enum, std::size_t N>
void add_choice(CLI::App& command, const std::string& flag, const Names<Enum, N>& names,
                Enum& value, const std::string& meaning) {
  command
      .add_option_function<std::string>(
          flag, [&](const std::string& name) { value = named(names, name); }, meaning)
      ->check(one_of(names))
      ->default_str(std::string(name_of(value)));
}

CLI::Validator seconds_from(double least) {
  return {[least](const std::string& text) -> std::string {
            const auto seconds = files::parse_double(text);
            const bool valid = seconds && *seconds >= least && std::abs(*seconds) < 9.2e9;
            return valid ? "" : fmt::format("'{}' is no such number of seconds", text);
          },
          "SECONDS"};
}

CLI::Validator count_from_one() {
  return {[](const std::string& text) -> std::string {
            const auto count = files::parse_integer(text);
            return count && *count >= 1 ? "" : fmt::format("'{}' is no count from 1 on", text);
          },
          "N"};
}

CLI::Validator delta() {
  return {[](const std::string& text) -> std::string {
            if (evaluation::parse_delta(text)) return "";
            return fmt::format(
                "'{}' is no distance between poses such as 10f, 100m, 5deg or 0.1rad", text);
          },
          "DELTA"};
}

/// Whether the estimate is that of a run: of folders all but those that hold a bag.
bool is_run(const fs::path& estimate) {
  if (!fs::is_directory(estimate)) return false;
  return std::none_of(fs::directory_iterator(estimate), fs::directory_iterator(),
                      [](const fs::directory_entry& entry) {
                        const fs::path extension = entry.path().extension();
                        return extension == ".bag" || extension == ".mcap" || extension == ".db3";
                      });
}

void require_sensible(const EvaluateArguments& arguments) {
  if (!arguments.reference && !arguments.checkpoints && !is_run(arguments.estimate)) {
    throw CLI::ValidationError(
        "--reference",
        "or --checkpoints is needed unless ESTIMATE is a run folder. Without either there is "
        "still: how sharp the map of the poses is (MME; `traverse import` and `run`), how well "
        "loops agree with them (a preset with slam.use=true: loops.csv), and whether repeats give "
        "the same (`repeats` in a batch's plan)");
  }
  if (arguments.from_s && arguments.to_s && *arguments.to_s < *arguments.from_s) {
    throw CLI::ValidationError("--to", "is before --from");
  }
  const AlignmentMode mode = arguments.options.alignment.mode;
  const bool from_positions = mode != AlignmentMode::kNone && mode != AlignmentMode::kOrigin;
  if (arguments.options.alignment.first && !from_positions) {
    throw CLI::ValidationError("--align-first", "needs --align se3, sim3 or scale");
  }
}

void choose_relations(const std::vector<std::string>& names,
                      evaluation::EvaluationOptions& options) {
  if (names.empty()) return;
  options.ape_relations.clear();
  options.rpe_relations.clear();
  for (const std::string& name : names) {
    const Relation relation = named(evaluation::kRelationNames, name);
    auto& chosen = options.rpe_relations;
    if (std::find(chosen.begin(), chosen.end(), relation) != chosen.end()) continue;
    chosen.push_back(relation);
    if (is_absolute(relation)) options.ape_relations.push_back(relation);
  }
}

void choose_rpe(const EvaluateArguments& arguments, evaluation::EvaluationOptions& options) {
  options.rpe_must_exist = !arguments.deltas.empty();
  const auto deltas = arguments.deltas.empty() ? std::vector<std::string>{"1f"} : arguments.deltas;
  for (const std::string& text : deltas) {
    options.rpe.push_back(
        {*evaluation::parse_delta(text), arguments.all_pairs, arguments.pairs_from});
  }
}

void require_files_of_run(const EvaluateArguments& arguments) {
  const pipeline::RunFolder run{arguments.estimate};
  std::vector<fs::path> files{run.trajectory(), run.evaluation()};
  if (!arguments.reference) files.push_back(run.reference());
  pipeline::require_as_written(run, files);
}

/// The drift of a run is measured in the frame that the run itself was evaluated in.
void take_frame_of_run(const fs::path& run, evaluation::KittiDriftOptions& options) {
  const fs::path file = run / "evaluation.json";
  if (!fs::exists(file)) return;
  const auto evaluation = evaluation::read_evaluation(file);
  if (!evaluation.comparison || !evaluation.comparison->kitti) return;
  const evaluation::KittiDrift& kitti = *evaluation.comparison->kitti;
  options.T_body_camera = kitti.T_body_camera;
  (kitti.T_body_camera ? options.camera_frame : options.body_frame) = kitti.frame;
}

/// What a run says of itself, which its figures do not.
void print_status_of_run(const fs::path& run) {
  const fs::path file = run / "run.json";
  if (!fs::exists(file)) return;
  const auto document = files::JsonDocument::read(file);
  const files::JsonValue record = document.root();
  const std::string status = record["status"].text();
  if (status != "ok") fmt::print("run          {}: {}\n", status, record["reason"].text());
}

/// Poses are matched by index: their frame numbers have to be that.
void require_no_gaps(const fs::path& file, const std::vector<std::size_t>& frame_numbers) {
  for (std::size_t i = 0; i < frame_numbers.size(); ++i) {
    if (frame_numbers[i] == i) continue;
    throw files::InputError(
        file, files::Place::whole_file(),
        "frame numbers from 0 on without a gap, since poses are matched by index",
        fmt::format("{} where {} is expected; give a TUM or EuRoC file, whose "
                    "poses have times",
                    frame_numbers[i], i));
  }
}

/// Whether a pose is of the time that is asked for.
bool is_within(const std::optional<geometry::Stamp>& stamp, const fs::path& file,
               const EvaluateArguments& arguments) {
  if (!arguments.from_s && !arguments.to_s) return true;
  if (!stamp) {
    throw files::InputError(file, files::Place::whole_file(),
                            "poses with stamps, since --from or --to is given",
                            "poses that go by number");
  }
  return !(arguments.from_s && *stamp < geometry::Stamp::from_seconds(*arguments.from_s)) &&
         !(arguments.to_s && *stamp > geometry::Stamp::from_seconds(*arguments.to_s));
}

/// The poses of that time, in memory.
geometry::Trajectory trajectory_within(const fs::path& file,
                                       const dataset::TrajectoryChoice& choice,
                                       const EvaluateArguments& arguments) {
  std::vector<geometry::Stamp> stamps;
  std::vector<geometry::Pose3> poses;
  dataset::read_poses(
      file, choice,
      [&](const std::optional<geometry::Stamp>& stamp, const geometry::Pose3& T_map_body) {
        if (!is_within(stamp, file, arguments)) return;
        if (stamp) stamps.push_back(*stamp);
        poses.push_back(T_map_body);
      });
  return stamps.empty() ? geometry::Trajectory::unstamped(std::move(poses))
                        : geometry::Trajectory::stamped(std::move(stamps), std::move(poses));
}

/// A trajectory that need not fit into memory, and as what its file was read.
struct ReadTrajectory {
  evaluation::TrajectoryStore poses;
  dataset::TrajectoryReading reading;

  ReadTrajectory(const fs::path& file, const dataset::TrajectoryChoice& choice,
                 const EvaluateArguments& arguments)
      : reading(dataset::read_poses(
            file, choice,
            [&](const std::optional<geometry::Stamp>& stamp, const geometry::Pose3& T_map_body) {
              if (is_within(stamp, file, arguments)) poses.push_back(stamp, T_map_body);
            })) {
    require_no_gaps(file, reading.frame_numbers);
    if (poses.size() > 0) return;
    throw files::InputError(file, files::Place::whole_file(), "poses from --from until --to",
                            "none");
  }

  evaluation::TrajectoryView view() const {
    evaluation::TrajectoryView view(poses);
    if (reading.format == TrajectoryFormat::kEuroc) {
      view.times = evaluation::TimesInFile::kNanoseconds;
    }
    return view;
  }
  void describe_in(evaluation::TrajectoryFacts& facts, const fs::path& file) const {
    facts.name = file.string();
    facts.read_as = describe(reading);
    facts.notes = reading.notes;
  }
};

/// Residuals at surveyed points, in place of a reference trajectory.
void evaluate_at_checkpoints(const EvaluateArguments& arguments) {
  fs::path estimate_file = arguments.estimate;
  if (is_run(arguments.estimate)) {
    estimate_file = arguments.estimate / "trajectory.tum";
    pipeline::require_as_written(pipeline::RunFolder{arguments.estimate}, {estimate_file});
    print_status_of_run(arguments.estimate);
  }
  const geometry::Trajectory estimate = dataset::read_trajectory(estimate_file, arguments.choice);
  evaluation::CheckpointOptions options;
  if (arguments.has_alignment) options.alignment = arguments.options.alignment.mode;
  if (options.alignment == AlignmentMode::kOrigin || options.alignment == AlignmentMode::kScale) {
    throw CLI::ValidationError("--align", "of checkpoints is none, se3 or sim3");
  }
  if (!arguments.point.empty()) {
    options.p_body = {arguments.point[0], arguments.point[1], arguments.point[2]};
  }
  options.time_offset_s = -arguments.options.association.time_offset_s;
  const evaluation::CheckpointEvaluation result = evaluation::evaluate_checkpoints(
      estimate, evaluation::read_checkpoints(*arguments.checkpoints), options);
  fmt::print("{}", evaluation::to_table(result));
  if (arguments.json) write_json_output(*arguments.json, evaluation::to_json(result));
}

/// The document is written as it is made: in memory it is many times as large as what it tells.
void evaluate(const EvaluateArguments& arguments) {
  require_sensible(arguments);
  if (arguments.checkpoints) {
    evaluate_at_checkpoints(arguments);
    return;
  }
  evaluation::EvaluationOptions options = arguments.options;
  choose_relations(arguments.relations, options);
  choose_rpe(arguments, options);

  fs::path estimate_file = arguments.estimate;
  fs::path reference_file = arguments.reference.value_or(arguments.estimate / "reference.tum");
  if (is_run(arguments.estimate)) {
    require_files_of_run(arguments);
    estimate_file = arguments.estimate / "trajectory.tum";
    take_frame_of_run(arguments.estimate, options.kitti);
    print_status_of_run(arguments.estimate);
  }
  const ReadTrajectory estimate(estimate_file, arguments.choice, arguments);
  const dataset::TrajectoryChoice of_reference{
      arguments.reference_format.value_or(
          is_run(arguments.estimate) || !arguments.choice.columns.empty() ||
                  !arguments.choice.topic.empty() || !arguments.reference_columns.empty() ||
                  !arguments.reference_topic.empty()
              ? TrajectoryFormat::kAuto
              : arguments.choice.format),
      arguments.reference_columns, arguments.reference_topic};
  const ReadTrajectory reference(reference_file, of_reference, arguments);
  evaluation::Evaluation evaluation =
      evaluation::evaluate(estimate.view(), reference.view(), options);
  estimate.describe_in(evaluation.estimate, estimate_file);
  reference.describe_in(evaluation.comparison->reference, reference_file);

  fmt::print("{}", to_table(evaluation));
  if (arguments.json) {
    write_json_output(*arguments.json,
                      [&](std::ostream& stream) { evaluation::write_json(evaluation, stream); });
  }
  if (arguments.plot) {
    const auto read = [&](const fs::path& file, const dataset::TrajectoryChoice& choice) {
      return trajectory_within(file, choice, arguments);
    };
    const std::size_t pictures = report::draw_evaluation(
        {read(estimate_file, arguments.choice), read(reference_file, of_reference), evaluation,
         estimate_file.filename().string(), reference_file.filename().string()},
        *arguments.plot);
    fmt::print("{} pictures in {}\n", pictures, arguments.plot->string());
  }
  if (arguments.budget) require_kept(report::check_budget(*arguments.budget, evaluation));
}

}  // namespace

void add_evaluate(CLI::App& app) {
  CLI::App& command =
      *app.add_subcommand("evaluate", "Compare an estimated trajectory with a reference");
  const auto arguments = std::make_shared<EvaluateArguments>();
  evaluation::EvaluationOptions& options = arguments->options;

  command
      .add_option("ESTIMATE", arguments->estimate,
                  "trajectory file, or a run folder with trajectory.tum")
      ->type_name("FILE|RUN")
      ->required();
  command
      .add_option("--reference", arguments->reference,
                  "trajectory file; of a run folder its reference.tum is the default")
      ->type_name("FILE");
  add_choice(command, "--format", dataset::kTrajectoryFormatNames, arguments->choice.format,
             "of both files; auto looks at the content");
  command
      .add_option_function<std::string>(
          "--reference-format",
          [arguments](const std::string& name) {
            arguments->reference_format = named(dataset::kTrajectoryFormatNames, name);
          },
          "of the reference alone")
      ->check(one_of(dataset::kTrajectoryFormatNames));
  command
      .add_option("--columns", arguments->choice.columns,
                  "of an estimate in a CSV file: t,x,y,z,qx,qy,qz,qw in their order, or t=NAME,...")
      ->type_name("NAMES");
  command
      .add_option("--reference-columns", arguments->reference_columns,
                  "of a reference in a CSV file, likewise")
      ->type_name("NAMES");
  command.add_option("--topic", arguments->choice.topic, "of an estimate in a bag")
      ->type_name("TOPIC");
  command.add_option("--reference-topic", arguments->reference_topic, "of a reference in a bag")
      ->type_name("TOPIC");
  command
      .add_option("--from", arguments->from_s, "leave poses before this stamp out, of both files")
      ->check(seconds_from(-9.2e9));
  command.add_option("--to", arguments->to_s, "leave poses after this stamp out")
      ->check(seconds_from(-9.2e9));
  command
      .add_option("--checkpoints", arguments->checkpoints,
                  "surveyed points in place of a reference: a CSV file with name, stamp_s (or "
                  "from_s, to_s, or the number of a stop), e_m, n_m, h_m, sigma_m, use; a prism's "
                  "or a receiver's places without names")
      ->type_name("FILE")
      ->check(CLI::ExistingFile);
  command
      .add_option("--point", arguments->point,
                  "what stood over the checkpoints, in the body: an antenna, a prism")
      ->type_name("X,Y,Z")
      ->delimiter(',')
      ->expected(3);
  add_choice(command, "--align", evaluation::kAlignmentNames, options.alignment.mode,
             "bring the estimate onto the reference: its first pose (origin), by least squares "
             "(se3; sim3 with scale), or the scale alone");
  command
      .add_option("--align-first", options.alignment.first,
                  "find the alignment from the first N poses, apply it to all")
      ->check(count_from_one());
  command
      .add_option("--max-time-difference", options.association.max_time_difference_s,
                  "poses further apart do not belong together")
      ->check(seconds_from(0))
      ->capture_default_str();
  command
      .add_option("--time-offset", options.association.time_offset_s,
                  "added to the stamps of the estimate")
      ->check(seconds_from(-9.2e9))
      ->capture_default_str();
  command
      .add_option("--relation", arguments->relations,
                  "what is measured of each error, for APE and RPE; may be repeated")
      ->check(one_of(evaluation::kRelationNames))
      ->allow_extra_args(false);
  command
      .add_option("--rpe", arguments->deltas,
                  "relative error over so many frames, metres, degrees or radians, as 10f, 100m, "
                  "5deg, 0.1rad; may be repeated")
      ->check(delta())
      ->allow_extra_args(false);
  command.add_flag("--all-pairs", arguments->all_pairs,
                   "RPE over all pairs that far apart, not only consecutive ones");
  add_choice(command, "--pairs-from", evaluation::kPairsFromNames, arguments->pairs_from,
             "whose path decides how far apart two poses are");
  command
      .add_option("--kitti-step", options.kitti.step,
                  "poses from the start of one stretch of the KITTI drift to the next")
      ->check(count_from_one())
      ->capture_default_str();
  command
      .add_option(
          "--sub-trajectories", options.sub_trajectory_lengths_m,
          "lengths of the stretches of rpg_trajectory_evaluation's relative errors; else 10 "
          "to 50 % of the reference")
      ->type_name("METRES,...")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(0.01, 1e7).description(""));
  command
      .add_option("--json", arguments->json,
                  "write every figure with the values behind it to this file")
      ->type_name("FILE");
  command
      .add_option(
          "--plot", arguments->plot,
          "folder for pictures: trajectories, errors along them, over time, and their spread; "
          "PNG, SVG, PDF")
      ->type_name("DIR");
  add_budget_option(command, arguments->budget);
  command.footer(kEvaluateExamples);
  command.callback([arguments, &command] {
    arguments->has_alignment = command.count("--align") > 0;
    evaluate(*arguments);
  });
}

}  // namespace traverse::app
