#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "traverse/batch/plan.hpp"

namespace traverse::batch {

/// One run of a plan: a line of the plan's table, what it starts, and who it is.
struct Job {
  std::string id;        ///< SHA-256 of `identity`, 64 hexadecimal digits
  std::string identity;  ///< all that the result depends on, as lines of text
  std::string recording;
  std::string pipeline;
  std::vector<std::string> settings;   ///< "solver.huber_m=0.2", of the grid only
  int repeat = 1;                      ///< counted from 1
  std::vector<std::string> arguments;  ///< of the program: "run", RECORDING, ...; output is "run"
  /// Of a program that is not ours, for /bin/sh: it is started first, in a folder of its own, and
  /// what it writes (`trajectory`) takes the place of kTrajectory in `arguments`. Empty: a preset.
  std::string command = {};
  std::string trajectory = {};  ///< path or pattern
  bool in_container = false;    ///< then its processes are not all of its group
  RunLimits limits;

  static constexpr const char* kTrajectory = "{trajectory}";

  /// Whether what comes of it must not tell whose machine made it.
  bool is_private() const;
  /// "floam solver.huber_m=0.2": the pipeline and its point of the grid.
  std::string variant() const;
  /// "drive_0001, floam solver.huber_m=0.2, repeat 2"
  std::string title() const;
};

/// What tells one recording from another: the digest of its content.
using RecordingDigests = std::map<std::string, std::string>;  ///< name of the plan: SHA-256

/// Every run of the plan, in the order of the plan. Runs that are the same in everything that
/// counts (a grid point that is the preset's own value, say) have the same id.
/// \param recordings digest of each of the plan's recordings
/// \param program what the program is: version, commit, digest of an uncommitted build
/// \throws files::InputError for a setting that the preset does not take, with the plan's line.
std::vector<Job> make_jobs(const Plan& plan, const RecordingDigests& recordings,
                           const std::string& program, const std::filesystem::path& share_folder);

/// The first job of each id.
std::vector<Job> distinct(const std::vector<Job>& jobs);

/// One job a line. \throws files::OutputError
void write_jobs(const std::filesystem::path& file, const std::vector<Job>& jobs);
/// \param first, count the lines to take, from 0
/// \throws files::InputError naming the line.
std::vector<Job> read_jobs(const std::filesystem::path& file, std::size_t first = 0,
                           std::size_t count = static_cast<std::size_t>(-1));

}  // namespace traverse::batch
