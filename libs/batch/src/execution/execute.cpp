#include "traverse/batch/execute.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <deque>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <unistd.h>
#include <vector>

#include <fmt/format.h>
#include <glob.h>

#include "traverse/batch/metric.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/digest.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/json_document.hpp"
#include "traverse/files/numbers.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/files/unfinished.hpp"
#include "traverse/pipeline/privacy.hpp"
#include "traverse/pipeline/provenance.hpp"
#include "traverse/pipeline/recording_place.hpp"
#include "traverse/pipeline/run_destination.hpp"
#include "traverse/pipeline/run_folder.hpp"

#include "execution/host_name.hpp"
#include "execution/run_output.hpp"
#include "execution/run_process.hpp"

namespace traverse::batch {

namespace {

namespace fs = std::filesystem;
using Cause = ProcessEnd::Cause;

constexpr std::size_t kLastLines = 20;
constexpr std::size_t kLongestLine = 400;
constexpr const char* kPartial = ".partial";
constexpr const char* kDiscarded = ".discarded";
constexpr std::array kAskedToEnd{SIGINT, SIGTERM, SIGHUP};
constexpr int kSignalled = 128;  // and the signal: a run that was asked to end has done so

/// ".0123456789abcdef.host.4711.partial"
fs::path work_folder(const BatchFolder& folder, const Job& job) {
  return folder.runs() / fmt::format(".{}.{}.{}{}", BatchFolder::run_name(job.id), host_name(),
                                     ::getpid(), kPartial);
}

void begin_empty(const fs::path& folder) {
  std::error_code failure;
  fs::remove_all(folder, failure);
  if (!failure) fs::create_directory(folder, failure);
  if (failure) throw files::OutputError(folder, failure.message());
}

std::vector<std::string> last_lines(const fs::path& log) {
  std::ifstream stream(log);
  std::deque<std::string> lines;
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line.substr(0, kLongestLine));
    if (lines.size() > kLastLines) lines.pop_front();
  }
  return {lines.begin(), lines.end()};
}

struct RunStatus {
  std::string status;
  std::string reason;
};

RunStatus status_of(const fs::path& run_folder) {
  try {
    const auto document = files::JsonDocument::read(pipeline::RunFolder{run_folder}.record());
    const files::JsonValue record = document.root();
    return {record["status"].text(), record.has("reason") ? record["reason"].text() : ""};
  } catch (const files::InputError&) {
    return {};  // a run that crashed before it wrote its record, or while it did
  }
}

/// How often the system killed something because memory ran out.
long out_of_memory_kills() {
  std::ifstream stream("/proc/vmstat");
  std::string name;
  for (long count = 0; stream >> name >> count;) {
    if (name == "oom_kill") return count;
  }
  return 0;
}

/// The line of the log that says why: the program's own message, else the last one.
std::string message_of(const std::vector<std::string>& lines) {
  constexpr std::string_view kOwn = "traverse: ";
  for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
    if (line->starts_with(kOwn)) return line->substr(kOwn.size());
  }
  return lines.empty() ? "no message" : lines.back();
}

/// Ended from outside: nothing the run did, and nothing that would happen again.
bool was_killed(const ProcessEnd& end, const RunStatus& status, bool memory_ran_out) {
  if (end.cause != Cause::kItself) return false;
  if (end.signal == SIGKILL) return !memory_ran_out;
  return std::any_of(kAskedToEnd.begin(), kAskedToEnd.end(),
                     [&](int signal) {
                       return end.signal == signal || end.exit_status == kSignalled + signal;
                     }) ||
         status.status == "interrupted";
}

void judge(const Job& job, const ProcessEnd& end, const RunStatus& status, bool memory_ran_out,
           Completion& completion) {
  const std::string message = message_of(completion.last_lines);
  if (end.cause == Cause::kTimeLimit) {
    completion.outcome = Outcome::kTimedOut;
    completion.reason = fmt::format("more than {:g} s", job.limits.time_s);
  } else if (end.cause == Cause::kMemoryLimit) {
    completion.outcome = Outcome::kOutOfMemory;
    completion.reason = fmt::format("more than {:g} MB", job.limits.memory_mb);
  } else if (memory_ran_out || message.find("out of memory") != std::string::npos) {
    completion.outcome = Outcome::kOutOfMemory;
    completion.reason = "the machine had no more memory";
  } else if (end.signal != 0) {
    completion.outcome = Outcome::kCrashed;
    completion.reason = fmt::format("signal {} ({})", end.signal, ::strsignal(end.signal));
    if (completion.attempts > 1) {
      completion.reason += fmt::format(", {} attempts", completion.attempts);
    }
  } else if (!completion.reason.empty()) {
    completion.outcome = Outcome::kFailed;  // a command that ended without what it is to write
  } else if (end.exit_status != 0) {
    completion.outcome = status.status == "lost" ? Outcome::kLost : Outcome::kFailed;
    completion.reason = status.status == "lost" ? status.reason : message;
  } else if (status.status == "degraded") {
    completion.outcome = Outcome::kDegraded;
    completion.reason = status.reason;
  } else {
    completion.outcome = Outcome::kOk;
  }
}

void add_results(const fs::path& work, Completion& completion) {
  const pipeline::RunFolder run{work};
  completion.metrics = read_metrics(work);
  for (const auto& [name, value] :
       {MetricValue{"wall_s", completion.wall_s}, MetricValue{"cpu_s", completion.cpu_s},
        MetricValue{"peak_memory_mb", completion.peak_memory_mb}}) {
    completion.metrics.emplace_back(name, value);
  }
  completion.has_report = fs::is_regular_file(run.report());
  if (fs::is_regular_file(run.trajectory())) {
    completion.trajectory_sha256 = files::sha256_of_file(run.trajectory());
  }
}

/// Gives the run its name. \returns the record that stands there: another process may have been
/// faster with the same run.
Completion publish(const fs::path& work, const Job& job, const Completion& completion,
                   const BatchFolder& folder) {
  const fs::path place = folder.run(job.id);
  std::error_code failure;
  fs::rename(work, place, failure);
  if (!failure) return completion;
  const auto there = find_completion(folder.completion(job.id));
  if (there && !is_outdated(*there, job)) {
    fs::remove_all(work, failure);
    return *there;
  }
  discard(folder, job);
  fs::rename(work, place, failure);
  if (failure) throw files::OutputError(place, failure.message());
  return completion;
}

/// What the run has written comes into the folder that its log is in already.
void take_out_of_its_folder(const fs::path& work) {
  std::error_code failure;
  std::vector<fs::path> written;
  for (const auto& entry : fs::directory_iterator(work / kRunOutput, failure)) {
    written.push_back(entry.path());
  }
  for (const fs::path& path : written) {
    fs::rename(path, work / path.filename(), failure);
    if (failure) throw files::OutputError(work, failure.message());
  }
  fs::remove(work / kRunOutput, failure);
  // What a killed run was writing to is not finished.
  fs::remove_all(pipeline::RunDestination::work_folder(work / kRunOutput), failure);
}

/// The program's messages name what it worked on.
void make_private(const fs::path& log, const pipeline::Privacy& privacy, Completion& completion) {
  files::write_text(log, privacy.text(files::read_text(log)));
  completion.last_lines = privacy.texts(completion.last_lines);
  completion.reason = privacy.text(completion.reason);
}

Completion finish(const fs::path& work, const Job& job, const ProcessEnd& end, bool memory_ran_out,
                  Completion completion, const BatchFolder& folder) {
  completion.exit_status = end.exit_status;
  completion.signal = end.signal;
  completion.wall_s = end.wall_s;
  completion.cpu_s = end.cpu_s;
  completion.peak_memory_mb = end.peak_memory_mb;
  take_out_of_its_folder(work);
  pipeline::retell_place({work}, work / kRunOutput, folder.run(job.id));
  completion.last_lines = last_lines(work / "log.txt");
  judge(job, end, status_of(work), memory_ran_out, completion);
  if (is_usable(completion.outcome)) completion.last_lines.clear();
  if (job.is_private()) {
    make_private(work / "log.txt", pipeline::Privacy(folder.run(job.id)), completion);
  }
  add_results(work, completion);
  files::write_text(work / "result.json", to_json(completion));
  return publish(work, job, completion, folder);
}

/// The process of this host that a folder of such a name belongs to; nothing for any other name.
std::optional<std::int64_t> maker_of(std::string_view name) {
  constexpr std::size_t kDigits = 16;
  const auto take = [&](std::string_view end) {
    if (!name.ends_with(end)) return false;
    name.remove_suffix(end.size());
    return true;
  };
  if (!take(kPartial)) return std::nullopt;
  if (take(kDiscarded) && !take(kPartial)) return std::nullopt;
  const std::string ours = "." + host_name() + ".";
  if (name.size() < 1 + kDigits || name[0] != '.') return std::nullopt;
  const std::string_view id = name.substr(1, kDigits);
  if (id.find_first_not_of("0123456789abcdef") != std::string_view::npos) return std::nullopt;
  name.remove_prefix(1 + kDigits);
  if (!name.starts_with(ours)) return std::nullopt;
  return files::parse_integer(name.substr(ours.size()));
}

/// In the environment of the programs that are not ours: the folder of their run.
constexpr std::string_view kWorkOf = "TRAVERSE_BATCH_WORK=";

/// Ends what a program that is not ours started and left behind, or was started by a batch that was
/// killed: processes that have the run's folder in their environment, which no other run has.
void end_programs_of(const fs::path& work) {
  const std::string mark = std::string(kWorkOf) + work.string();
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator("/proc", failure)) {
    const auto pid = files::parse_integer(entry.path().filename().string());
    if (!pid || *pid == ::getpid()) continue;
    std::ifstream stream(entry.path() / "environ", std::ios::binary);
    for (std::string variable; std::getline(stream, variable, '\0');) {
      if (variable != mark) continue;
      ::kill(static_cast<pid_t>(*pid), SIGKILL);
      break;
    }
  }
}

/// What a program that is not ours has written, of the pattern that the plan names. \returns
/// nothing, and in `reason` why, unless it is one
std::optional<fs::path> find_trajectory(const fs::path& folder, const std::string& pattern,
                                        std::string& reason) {
  glob_t found{};
  const std::string full = (fs::path(pattern).is_absolute() ? fs::path(pattern) : folder / pattern);
  const int failure = ::glob(full.c_str(), 0, nullptr, &found);
  std::vector<fs::path> files;
  for (std::size_t i = 0; failure == 0 && i < found.gl_pathc; ++i) {
    files.emplace_back(found.gl_pathv[i]);
  }
  ::globfree(&found);
  if (files.size() == 1) return files.front();
  reason = fmt::format("the command ended, but expected one trajectory {}, found {}", pattern,
                       files.empty() ? std::string("none") : fmt::format("{}", files.size()));
  return std::nullopt;
}

/// A path below a folder from there; any other as it is.
fs::path told_from(const fs::path& folder, const fs::path& path) {
  const fs::path from_folder = path.lexically_relative(folder);
  return from_folder.empty() || *from_folder.begin() == ".." ? path : from_folder;
}

/// A shell tells by its exit status that a program which it started was ended by a signal.
void take_signal_of_shell(ProcessEnd& end) {
  constexpr int kMostSignals = 64;
  const int signal = end.exit_status - kSignalled;
  if (end.cause != Cause::kItself || signal < 1 || signal > kMostSignals) return;
  end.signal = signal;
  end.exit_status = 0;
}

/// Runs a program that is not ours, measured from outside, and then takes over what it wrote, which
/// is not part of what it is measured by.
ProcessEnd run_command(const Job& job, const ExecutionContext& context, const fs::path& work,
                       ProcessStart start, std::string& reason) {
  const fs::path folder = work / kCommandFolder;
  fs::create_directory(folder);
  ProcessStart command = start;
  command.program = "/usr/bin/env";
  command.folder = folder;
  command.is_group = true;
  const std::string mark = std::string(kWorkOf) + work.string();
  if (job.in_container) command.mark = mark;
  command.arguments = {mark, fmt::format("OMP_NUM_THREADS={}", job.limits.threads), "/bin/sh", "-c",
                       job.command};
  ProcessEnd end = run_process(command, context.stop);
  end_programs_of(work);
  take_signal_of_shell(end);
  if (end.cause != Cause::kItself || end.signal != 0 || end.exit_status != 0) return end;
  const auto trajectory = find_trajectory(folder, job.trajectory, reason);
  if (!trajectory) return end;
  files::write_text(work / kCommandCost,
                    fmt::format("threads: {}\nwall_s: {}\npeak_memory_mb: {}\n", job.limits.threads,
                                end.wall_s, end.peak_memory_mb));
  std::replace(start.arguments.begin(), start.arguments.end(), std::string(Job::kTrajectory),
               told_from(work, *trajectory).string());
  start.appends = true;
  ProcessEnd taken = run_process(start, context.stop);
  taken.wall_s = end.wall_s;
  taken.cpu_s = end.cpu_s;
  taken.peak_memory_mb = end.peak_memory_mb;
  return taken;
}

}  // namespace
fs::path log_in_work(const BatchFolder& folder, const Job& job) {
  return work_folder(folder, job) / "log.txt";
}

std::optional<Completion> execute(const Job& job, const ExecutionContext& context) {
  const fs::path work = work_folder(context.folder, job);
  const files::Unfinished unfinished(work);
  Completion completion;
  completion.id = job.id;
  completion.identity = job.identity;
  completion.limits = job.limits;
  if (!job.is_private()) completion.host = host_name();
  for (int attempt = 1;; ++attempt) {
    begin_empty(work);
    completion.attempts = attempt;
    completion.started_utc = pipeline::utc_now();
    ProcessStart start{context.program, job.arguments, work, work / "log.txt"};
    start.time_limit_s = job.limits.time_s;
    start.memory_limit_mb = job.limits.memory_mb;
    start.started = [&](int pid) { context.journal.started(job, pid, attempt); };
    const long kills_before = out_of_memory_kills();
    completion.reason.clear();
    const ProcessEnd end = job.command.empty()
                               ? run_process(start, context.stop)
                               : run_command(job, context, work, start, completion.reason);
    if (end.cause == Cause::kStopped || (context.stop && end.signal != 0)) {
      std::error_code ignored;
      fs::remove_all(work, ignored);
      return std::nullopt;
    }
    const bool memory_ran_out = end.cause == Cause::kItself && end.signal == SIGKILL &&
                                out_of_memory_kills() > kills_before;
    if (was_killed(end, status_of(work / kRunOutput), memory_ran_out)) {
      context.journal.killed(
          job, end.signal != 0 ? end.signal : std::max(0, end.exit_status - kSignalled));
      if (attempt < job.limits.attempts) continue;
    }
    completion = finish(work, job, end, memory_ran_out, std::move(completion), context.folder);
    context.journal.finished(job, completion);
    return completion;
  }
}

void discard(const BatchFolder& folder, const Job& job) {
  // First out of the way by one rename: a folder that is half removed must not look finished.
  const fs::path aside = work_folder(folder, job).string() + kDiscarded + kPartial;
  std::error_code failure;
  fs::remove_all(aside, failure);
  fs::rename(folder.run(job.id), aside, failure);
  if (failure == std::errc::no_such_file_or_directory) return;
  if (!failure) fs::remove_all(aside, failure);
  if (failure) throw files::OutputError(folder.run(job.id), failure.message());
}

void remove_abandoned(const BatchFolder& folder) {
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(folder.runs(), failure)) {
    const auto pid = maker_of(entry.path().filename().string());
    if (!pid) continue;
    const bool alive = *pid != ::getpid() && ::kill(static_cast<pid_t>(*pid), 0) == 0;
    if (alive) continue;
    end_programs_of(entry.path());
    fs::remove_all(entry.path(), failure);
  }
}

}  // namespace traverse::batch
