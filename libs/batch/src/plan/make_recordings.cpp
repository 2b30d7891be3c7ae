#include <csignal>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/digest.hpp"
#include "traverse/files/text_file.hpp"

#include "execution/run_process.hpp"
#include "plan/plan_commands.hpp"
#include "plan/plan_error.hpp"
#include "plan/recordings.hpp"

namespace traverse::batch {

namespace {

namespace fs = std::filesystem;

/// Ended by something outside, which would not happen again.
bool was_killed(const ProcessEnd& end) {
  constexpr int kStatusOfSignals = 128;  // and the signal: it was asked to end
  return end.cause == ProcessEnd::Cause::kItself &&
         (end.signal == SIGKILL || end.signal == SIGTERM ||
          end.exit_status == kStatusOfSignals + SIGTERM);
}

/// Runs `traverse simulate` in a folder that gets its name when it is complete.
void make(const PlannedRecording& recording, const fs::path& place, const fs::path& program,
          int attempts, const std::atomic<bool>& stop) {
  files::AtomicFolder folder(place);
  const files::AtomicFile messages(place.string() + ".log");  // never committed
  const fs::path& log = messages.temporary_path();
  ProcessStart start{
      program, {"simulate", recording.generated->world}, folder.temporary_path(), log};
  for (const std::string& word : recording.generated->arguments) start.arguments.push_back(word);
  start.arguments.insert(start.arguments.end(), {"-o", recording.name + ".rawlog"});
  ProcessEnd end = run_process(start, stop);
  for (int attempt = 1; was_killed(end) && attempt < attempts; ++attempt) {
    end = run_process(start, stop);
  }
  if (end.cause == ProcessEnd::Cause::kStopped) return;
  if (end.exit_status != 0 || end.signal != 0) {
    throw plan_error(
        recording.origin,
        fmt::format("`traverse {}` to make '{}'", fmt::join(start.arguments, " "), recording.name),
        end.signal != 0 ? fmt::format("signal {}", end.signal) : files::read_text(log));
  }
  folder.commit();
}

/// Runs `traverse convert`, which makes what it writes whole or not at all.
void convert(const PlannedRecording& recording, const std::string& format, const fs::path& place,
             const fs::path& program, int attempts, const std::atomic<bool>& stop) {
  const files::AtomicFile messages(place.string() + ".log");  // never committed
  const fs::path& log = messages.temporary_path();
  ProcessStart start{
      program, {"convert", recording.path.string(), place.string()}, place.parent_path(), log};
  start.arguments.insert(start.arguments.end(), {"--format", format});
  if (!recording.statements_file.empty()) {
    start.arguments.insert(start.arguments.end(),
                           {"--recording-config", recording.statements_file.string()});
  }
  for (const std::string& statement : recording.statements) {
    start.arguments.insert(start.arguments.end(), {"--recording", statement});
  }
  ProcessEnd end = run_process(start, stop);
  for (int attempt = 1; was_killed(end) && attempt < attempts; ++attempt) {
    end = run_process(start, stop);
  }
  if (end.cause == ProcessEnd::Cause::kStopped) return;
  if (end.exit_status == 0 && end.signal == 0) return;
  throw plan_error(
      recording.origin,
      fmt::format("`traverse {}`, which a command reads", fmt::join(start.arguments, " ")),
      end.signal != 0 ? fmt::format("signal {}", end.signal) : files::read_text(log));
}

}  // namespace

void convert_recordings(Plan& plan, const BatchFolder& folder, const RecordingDigests& digests,
                        const fs::path& program, const std::atomic<bool>& stop,
                        const std::function<void(const std::string& name)>& converting) {
  for (PlannedRecording& recording : plan.recordings) {
    for (const PlannedPipeline& pipeline : plan.pipelines) {
      if (!recording.takes(pipeline.name)) continue;
      for (const std::string& format : pipeline.command.formats()) {
        if (stop) return;
        const fs::path place =
            folder.recordings() / fmt::format("{}-{}-{}{}", recording.name,
                                              digests.at(recording.name).substr(0, 12), format,
                                              ending_of_format(format));
        if (!fs::exists(place)) {
          converting(recording.name + " to " + format);
          convert(recording, format, place, program, plan.limits.attempts, stop);
        }
        recording.converted[format] = place;
      }
    }
  }
}

void make_recordings(Plan& plan, const BatchFolder& folder, const fs::path& program,
                     const std::string& program_id, const std::atomic<bool>& stop,
                     const std::function<void(const std::string& name)>& making) {
  for (PlannedRecording& recording : plan.recordings) {
    if (!recording.generated || stop) continue;
    const std::string content = fmt::format("{}\n{}\n{}", program_id, recording.generated->world,
                                            fmt::join(recording.generated->arguments, "\n"));
    const fs::path place =
        folder.recordings() /
        fmt::format("{}-{}", recording.name, files::sha256_of_text(content).substr(0, 12));
    if (!fs::is_directory(place)) {
      making(recording.name);
      make(recording, place, program, plan.limits.attempts, stop);
    }
    recording.path = place / (recording.name + ".rawlog");
  }
}

}  // namespace traverse::batch
