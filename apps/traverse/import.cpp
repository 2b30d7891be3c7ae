#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/config/settings.hpp"
#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/files/numbers.hpp"
#include "traverse/pipeline/clock_offset.hpp"
#include "traverse/pipeline/imported_poses.hpp"

#include "command_line.hpp"
#include "commands.hpp"
#include "run_arguments.hpp"
#include "standard_streams.hpp"

namespace traverse::app {

namespace {

constexpr const char* kImportExamples = R"(Examples:
  traverse import kiss.txt --recording DRIVE -o RUN --name KISS-ICP
                                        KITTI poses of the lidar, one for each scan
  traverse import poses.tum --recording drive.bag -o RUN --frame body --time-offset auto
                                        poses of the body, by another clock
  traverse import out.bag --topic /Odometry --recording drive.bag -o RUN --frame lidar \
                  --extrinsic 0.011,0.023,-0.044,0,0,0,1
                                        a topic whose frame (an IMU) sits so in the lidar's
  traverse import path.csv --columns t_ns,_,x,y,z,qx,qy,qz,qw --recording drive.mcap -o RUN
  traverse import graph.g2o --recording DRIVE -o RUN --frame camera --timing timing.yaml

Makes a whole run folder of poses that another program made: map, sharpness, pictures, evaluation,
report; `traverse compare` and traverse-replay take it as any other. Scans get the pose at their
stamp, interpolated between neighbours at most --max-gap apart; poses without stamps (KITTI, g2o)
go by number. What only that program knows (which frames it registered, its times) is left out.
--timing FILE is YAML with any of: threads, wall_s, peak_memory_mb, frame_ms (a list, one number a
pose). --recording takes statements too, as in --recording motion_compensated=false.)";

struct ImportArguments {
  RunArguments run;
  std::string trajectory;
  std::string name;
  pipeline::ImportOptions options;
  std::string time_offset;  ///< seconds or "auto"; empty: none
  std::vector<std::string> recording;
};

/// Of `--recording`, which stands for the recording and for statements about it.
void sort_recording(ImportArguments& arguments) {
  RecordingOptions& recording = arguments.run.recording;
  for (const std::string& given : arguments.recording) {
    const bool is_statement =
        given.find('=') != std::string::npos && !std::filesystem::exists(given);
    if (is_statement) {
      recording.statements.push_back(given);
    } else if (recording.recording.empty()) {
      recording.recording = given;
    } else {
      throw CLI::ValidationError(
          "--recording",
          fmt::format("one recording is needed, found {} and {}", recording.recording, given));
    }
  }
  if (recording.recording.empty()) {
    throw CLI::ValidationError("--recording", "a recording is needed beside statements about it");
  }
}

std::vector<sensors::ImuSample> gyroscope_of(dataset::Source& source) {
  std::vector<sensors::ImuSample> samples;
  const sensors::MountedSensor* imu = source.info().rig.first(sensors::SensorKind::kImu);
  if (imu == nullptr) return samples;
  const std::string label = imu->label;
  while (const auto measurement = source.next()) {
    const auto* sample = std::get_if<sensors::ImuSample>(&*measurement);
    if (sample != nullptr && sample->sensor == label) samples.push_back(*sample);
  }
  source.rewind();
  return samples;
}

/// The offset of the poses' clock, found from the motion itself.
void find_time_offset(dataset::Source& source, pipeline::ImportOptions& options) {
  const pipeline::ImportedPoses poses = pipeline::read_imported_poses(options, source.info());
  if (!poses.T_map_body.is_stamped()) {
    throw CLI::ValidationError("--time-offset", "the poses have no stamps: they go by number");
  }
  const std::vector<sensors::ImuSample> samples = gyroscope_of(source);
  pipeline::TurnedAngle turned;
  std::string by = "the gyroscope";
  if (!samples.empty()) {
    turned = pipeline::TurnedAngle::of(samples);
  } else if (source.reference()) {
    turned = pipeline::TurnedAngle::of(source.reference()->T_map_body);
    by = "the reference";
  } else {
    throw std::runtime_error(source.info().path.string() +
                             ": --time-offset auto needs a gyroscope or a reference to hold the "
                             "angular speed of the poses against, found neither; state the offset: "
                             "--time-offset SECONDS");
  }
  const auto offset =
      pipeline::find_clock_offset(pipeline::TurnedAngle::of(poses.T_map_body), turned);
  if (!offset) {
    throw std::runtime_error(fmt::format(
        "{}: --time-offset auto expects angular speeds that go together with those of {} at one "
        "offset alone, found none: they are of another drive, or of one that hardly turns; state "
        "the offset: --time-offset SECONDS",
        options.file, by));
  }
  options.time_offset_s = offset->seconds;
  options.time_offset_reason = fmt::format(
      "from the angular speeds of the poses and of {} (correlation {:.3f}, elsewhere "
      "at most {:.2f})",
      by, offset->correlation, std::max(0.0, offset->runner_up));
  print_message(fmt::format("clock: {:+.6f} s are added to the stamps of the poses, {}\n",
                            options.time_offset_s, options.time_offset_reason));
}

/// What the settings of the run are: `poses.*`.
std::vector<std::string> assignments_of(const pipeline::ImportOptions& options) {
  const auto text = [](const std::string& value) { return config::to_text(value); };
  return {"poses.file=" + text(options.file),
          "poses.format=" + options.format,
          "poses.columns=" + text(options.columns),
          "poses.topic=" + text(options.topic),
          "poses.frame=" + options.frame,
          "poses.extrinsic=" + config::to_text(options.extrinsic),
          "poses.time_offset_s=" + config::to_text(options.time_offset_s),
          "poses.time_offset_reason=" + text(options.time_offset_reason),
          "poses.max_gap_s=" + config::to_text(options.max_gap_s),
          std::string("poses.deskew=") + (options.deskew ? "true" : "false"),
          fmt::format("poses.first_scan={}", options.first_scan),
          "poses.timing=" + text(options.timing)};
}

void import_run(ImportArguments& arguments) {
  sort_recording(arguments);
  pipeline::ImportOptions& options = arguments.options;
  options.file = std::filesystem::absolute(arguments.trajectory).lexically_normal().string();
  if (!options.timing.empty()) {
    options.timing = std::filesystem::absolute(options.timing).lexically_normal().string();
  }
  options.first_scan = static_cast<std::int64_t>(arguments.run.first);
  const bool is_auto = arguments.time_offset == "auto";
  if (!is_auto && !arguments.time_offset.empty()) {
    options.time_offset_s = *files::parse_double(arguments.time_offset);
  }
  if (!is_auto && arguments.time_offset.empty()) options.time_offset_reason = "none was stated";
  std::filesystem::path named(options.file);
  if (!named.has_filename()) named = named.parent_path();
  arguments.run.imported = ImportedRun{
      arguments.trajectory, arguments.name.empty() ? named.stem().string() : arguments.name,
      [&options, is_auto](dataset::Source& source) {
        if (is_auto) find_time_offset(source, options);
        return assignments_of(options);
      }};
  make_run(arguments.run, command_line());
}

CLI::Validator seconds_or_auto() {
  return {[](const std::string& text) -> std::string {
            const auto seconds = files::parse_double(text);
            const bool valid = text == "auto" || (seconds && std::abs(*seconds) < 9.2e9);
            return valid ? "" : fmt::format("'{}' is neither a number of seconds nor auto", text);
          },
          "SECONDS|auto"};
}

std::vector<std::string> format_names() {
  std::vector<std::string> names;
  for (const auto& entry : dataset::kTrajectoryFormatNames) names.emplace_back(entry.first);
  return names;
}

}  // namespace

void add_import(CLI::App& app) {
  const auto arguments = std::make_shared<ImportArguments>();
  pipeline::ImportOptions& options = arguments->options;
  CLI::App* command = app.add_subcommand(
      "import", "make a run folder of poses that another program made of a recording");
  command->footer(kImportExamples);
  command->add_option("TRAJECTORY", arguments->trajectory, "trajectory file, or a bag with poses")
      ->required()
      ->check(CLI::ExistingPath);
  command
      ->add_option("--recording", arguments->recording,
                   "what the poses were made of; and, as KEY=VALUE, statements about it")
      ->type_name("RECORDING")
      ->required()
      ->allow_extra_args(false);
  command
      ->add_option("--recording-config", arguments->run.recording.config,
                   "YAML file of statements about the recording, over its own traverse.yaml")
      ->option_text("FILE");
  add_run_folder_options(*command, arguments->run);
  command->add_option("--name", arguments->name,
                      "of the program that made the poses, for titles; else the file's");
  command->add_option("--format", options.format, "of the trajectory; auto looks at the content")
      ->check(CLI::IsMember(format_names()))
      ->capture_default_str();
  command
      ->add_option(
          "--columns", options.columns,
          "of a CSV file: t,x,y,z,qx,qy,qz,qw in their order (_ for others), or t=NAME,...")
      ->type_name("NAMES");
  command->add_option("--topic", options.topic, "of a bag: the one with the poses")
      ->type_name("TOPIC");
  command
      ->add_option("--frame", options.frame,
                   "what moves along the poses, or what --extrinsic is relative to")
      ->check(CLI::IsMember({"body", "lidar", "camera"}))
      ->capture_default_str();
  command
      ->add_option("--extrinsic", options.extrinsic,
                   "pose of what moves along them in that frame: 7 numbers, or the 12 of a 3x4")
      ->type_name("X,Y,Z,QX,QY,QZ,QW")
      ->delimiter(',');
  command
      ->add_option("--time-offset", arguments->time_offset,
                   "added to the stamps of the poses; auto finds it by angular speeds")
      ->check(seconds_or_auto());
  command
      ->add_option("--max-gap", options.max_gap_s,
                   "poses further apart are not interpolated between, seconds")
      ->check(CLI::Range(0.0, 3600.0).description(""))
      ->type_name("SECONDS")
      ->capture_default_str();
  command->add_flag("!--no-deskew", options.deskew,
                    "leave scans as recorded; else the poses' own motion is undone within them");
  command->add_option("--timing", options.timing, "what the other program's run cost, as YAML")
      ->type_name("FILE")
      ->check(CLI::ExistingFile);
  command
      ->add_option("--reference", arguments->run.reference,
                   "reference trajectory (TUM, KITTI, EuRoC)")
      ->type_name("FILE")
      ->check(CLI::ExistingFile);
  command
      ->add_option("--reference-frame", arguments->run.reference_frame,
                   "what moves along the reference: body, lidar or camera")
      ->check(CLI::IsMember({"body", "lidar", "camera"}));
  command->callback([arguments] { import_run(*arguments); });
}

}  // namespace traverse::app
