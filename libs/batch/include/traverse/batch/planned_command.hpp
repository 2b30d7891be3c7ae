#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace traverse::batch {

/// An image in which a command runs.
struct PlannedContainer {
  std::string image;              ///< as the plan names it; empty: the command runs on this machine
  std::string digest;             ///< who the image is
  std::filesystem::path runtime;  ///< apptainer or podman
  std::string run_as;             ///< what the runtime is told: a file, or the image's id
  bool is_file = false;           ///< of apptainer

  explicit operator bool() const { return !image.empty(); }
};

/// A program that is not ours as a pipeline: how it is started, and what its poses are.
struct PlannedCommand {
  std::string text;        ///< for /bin/sh, with {recording} and the like; empty: a preset instead
  std::string trajectory;  ///< of what it writes: a path or pattern, from the folder it works in
  std::string version;     ///< of the program, as told
  PlannedContainer container;
  std::filesystem::path config_file;  ///< {config}: absolute, or empty
  std::string format = "auto";        ///< these as `traverse import` has them
  std::string columns;
  std::string topic;
  std::string frame = "lidar";
  std::vector<double> extrinsic;
  std::string time_offset;
  double max_gap_s = 0.5;
  bool deskew = true;
  /// Digests of all that the result depends on beside the recording: of the program and of the
  /// files that the command names.
  std::string identity;

  explicit operator bool() const { return !text.empty(); }
  /// The formats of {format:NAME}, each once, in order.
  std::vector<std::string> formats() const;
};

/// What stands for the placeholders of a command.
struct CommandPlaces {
  std::filesystem::path recording;
  std::map<std::string, std::filesystem::path> converted;  ///< by format
  std::filesystem::path plan_folder;
  int threads = 1;
  std::vector<std::string> settings;  ///< "voxel_m=0.5": {voxel_m}
};

/// The command with everything in its place, in quotes where it is a path; {out} is the working
/// folder. Where it has a container, as its program starts it.
/// \throws std::invalid_argument naming a placeholder that stands for nothing
std::string expanded(const PlannedCommand& command, const CommandPlaces& places);

}  // namespace traverse::batch
