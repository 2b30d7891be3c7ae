#include <filesystem>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "traverse/dataset/recording_slice.hpp"
#include "traverse/dataset/recording_writer.hpp"

#include "commands.hpp"
#include "recording_options.hpp"
#include "recording_progress.hpp"

namespace traverse::app {

namespace {

namespace fs = std::filesystem;
using dataset::BagFormat;
using dataset::BagPacking;
using dataset::RecordingWriter;
using dataset::ScanFolderFormat;
using dataset::Source;

struct ConvertOptions {
  RecordingOptions recording;
  std::string destination;
  std::string format;
  std::string lidar;
  std::string packing = "none";
  int gzip_level = 1;
  bool force = false;
  std::size_t first = 0;
  std::size_t last = std::numeric_limits<std::size_t>::max();
};

constexpr const char* kConvertExamples = R"(Examples:
  traverse convert 2011_09_26_drive_0001_sync drive.rawlog
  traverse convert drive.rawlog copy.bag                       a ROS 1 bag
  traverse convert drive.rawlog other.mcap --packing zstd      messages of ROS 2
  traverse convert drive.rawlog scans                          a folder of PCD files and tables
  traverse convert drive.rawlog sequence --format kitti
  traverse convert drive slice.rawlog --first 100 --last 199 --gzip 6

  traverse convert drive.rawlog log.txt                        IMU, wheels and GNSS as text

The ending of the destination tells the format, or --format does. X.rawlog, X.bag (ROS 1) and X.mcap
(ROS 2) take all sensors, with their facts in X.traverse.yaml, the reference trajectory in
X.reference.tum and the camera in X.calib.txt beside them. X.txt becomes a text log with lines IMU, ODOM
and GNSS, and its mountings in X.traverse.yaml. Any other destination becomes a folder of one lidar's
scans with imu.csv, gnss.csv and wheels.csv, which must not be there yet or be empty. What a format has
no place for, or rounds, is counted and told. Files of an earlier conversion are replaced when the new
ones are complete; files that this program did not write are refused.)";

std::string format_of(const ConvertOptions& options) {
  if (!options.format.empty()) return options.format;
  const fs::path ending = fs::path(options.destination).extension();
  for (const char* format : {"rawlog", "bag", "mcap"}) {
    if (ending == std::string(".") + format) return format;
  }
  return ending == ".txt" ? "log" : "pcd";
}

dataset::BagOptions bag_options(BagFormat format, const ConvertOptions& options,
                                const dataset::FilesThere& there) {
  const BagPacking packing = options.packing == "lz4"    ? BagPacking::kLz4
                             : options.packing == "zstd" ? BagPacking::kZstd
                                                         : BagPacking::kNone;
  return {format, packing, there};
}

/// The lidar whose scans are counted and, into a folder, written.
std::string choose_lidar(const Source& source, const std::string& wanted) {
  const sensors::Rig& rig = source.info().rig;
  const auto* lidar = wanted.empty() ? rig.first(sensors::SensorKind::kLidar) : rig.find(wanted);
  if (lidar != nullptr && lidar->kind == sensors::SensorKind::kLidar) return lidar->label;
  if (wanted.empty()) return {};
  std::string known;
  for (const auto& sensor : rig.sensors) {
    if (sensor.kind == sensors::SensorKind::kLidar) known += " '" + sensor.label + "'";
  }
  throw std::runtime_error(fmt::format("no lidar '{}' in the recording; there is:{}", wanted,
                                       known.empty() ? " none" : known));
}

std::unique_ptr<RecordingWriter> open_writer(const Source& source, const ConvertOptions& options,
                                             const std::string& lidar) {
  const dataset::FilesThere there{options.force, {}};
  const std::string format = format_of(options);
  if (format == "rawlog") {
    return dataset::write_rawlog(options.destination, source.info(), source.reference(),
                                 {options.gzip_level, there});
  }
  if (format == "bag" || format == "mcap") {
    const BagFormat bag = format == "bag" ? BagFormat::kRos1 : BagFormat::kMcap;
    return dataset::write_bag(options.destination, source.info(), source.reference(),
                              bag_options(bag, options, there));
  }
  if (format == "log") {
    return dataset::write_navigation_log(options.destination, source.info(), source.reference(),
                                         there);
  }
  if (lidar.empty()) {
    throw std::runtime_error("a folder holds lidar scans, and the recording has no lidar");
  }
  const ScanFolderFormat scans = format == "kitti" ? ScanFolderFormat::kKitti
                                 : format == "ply" ? ScanFolderFormat::kPly
                                                   : ScanFolderFormat::kPcd;
  return dataset::write_scan_folder(options.destination, source.info(), source.reference(), lidar,
                                    scans);
}

void refuse_to_overwrite_the_source(const fs::path& source, const fs::path& destination) {
  std::error_code ignored;
  if (fs::equivalent(source, destination, ignored)) {
    throw std::runtime_error("source and destination are the same: " + source.string());
  }
}

void print_result(const Source& source, const RecordingWriter& writer,
                  const dataset::SliceCount& count, const std::string& destination) {
  fmt::print("{}: {} scans, {} other records written\n", destination, count.frames, count.others);
  for (const auto& [what, number] : writer.left_out()) {
    fmt::print("  left out: {} {}\n", number, what);
  }
  for (const auto& [reason, skipped] : source.skipped().by_reason()) {
    fmt::print("  skipped: {} x {} (first: {})\n", skipped.count, reason,
               skipped.first_places.front());
  }
}

void run_convert(const ConvertOptions& options) {
  refuse_to_overwrite_the_source(options.recording.recording, options.destination);
  const auto source = options.recording.open();
  const std::string lidar = choose_lidar(*source, options.lidar);
  const auto writer = open_writer(*source, options, lidar);
  RecordingProgress progress("converting", *source);
  const dataset::SliceCount count = dataset::for_each_in_slice(
      *source, {lidar, options.first, options.last}, [&](const auto& measurement) {
        writer->add(measurement);
        progress.update(measurement);
      });
  progress.finish();
  if (count.frames + count.others == 0) {
    throw std::runtime_error(fmt::format(
        "nothing to convert: {} has no record in the frames asked for", source->info().name));
  }
  writer->commit();
  print_result(*source, *writer, count, options.destination);
}

}  // namespace

void add_convert(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "convert",
      "Writes a recording as an MRPT rawlog, a ROS 1 bag, MCAP, a folder of scans or a text log, "
      "nothing lost that the format can hold");
  auto options = std::make_shared<ConvertOptions>();
  add_recording_options(*command, options->recording, "SRC");
  command->add_option("DST", options->destination, "X.rawlog, X.bag, X.mcap, X.txt, or a folder")
      ->required();
  command
      ->add_option(
          "--format", options->format,
          "rawlog, bag, mcap or log, if the name does not tell; of a folder pcd (default), "
          "ply or kitti")
      ->check(CLI::IsMember({"rawlog", "bag", "mcap", "log", "pcd", "ply", "kitti"}))
      ->option_text("NAME");
  command
      ->add_option("--packing", options->packing, "of a bag's chunks: none, lz4 or, of MCAP, zstd")
      ->check(CLI::IsMember({"none", "lz4", "zstd"}))
      ->capture_default_str();
  command->add_option("--gzip", options->gzip_level, "compression of a rawlog, 0 (none) to 9")
      ->check(CLI::Range(0, 9))
      ->capture_default_str();
  command->add_option("--lidar", options->lidar, "label of the lidar to take, if not the first")
      ->option_text("LABEL");
  command->add_option("--first", options->first, "first frame, counted from 0")
      ->check(CLI::NonNegativeNumber)
      ->option_text("N");
  command->add_option("--last", options->last, "last frame, included")
      ->check(CLI::NonNegativeNumber)
      ->option_text("N");
  command->add_flag("--force", options->force,
                    "replace files at and beside X.rawlog, X.bag, X.mcap or X.txt that this "
                    "program did not write");
  command->footer(kConvertExamples);
  command->callback([options] { run_convert(*options); });
}

}  // namespace traverse::app
