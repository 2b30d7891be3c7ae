#include "run_info.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "traverse/files/input_error.hpp"
#include "traverse/files/json_document.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/pipeline/recording_place.hpp"
#include "traverse/pipeline/run_contents.hpp"
#include "traverse/pipeline/run_digests.hpp"

#include "run_summary.hpp"
#include "table.hpp"

namespace traverse::app {

namespace {

namespace fs = std::filesystem;
using files::JsonValue;
using nlohmann::ordered_json;

/// A run folder with what `info` tells of it; every file that is there was checked.
class LookedAtRun {
 public:
  explicit LookedAtRun(const fs::path& folder)
      : folder_{folder},
        document_(
            files::JsonDocument::parse(files::read_text(folder_.record()), folder_.record())) {
    pipeline::require_as_written(folder_, folder_.files());
    // A run that failed may have poses without figures, or its record alone.
    if (fs::exists(folder_.trajectory())) {
      contents_ = pipeline::read_run(
          folder_, has_figures() ? pipeline::RunPart::kFigures : pipeline::RunPart::kReference);
    }
  }

  const pipeline::RunFolder& folder() const { return folder_; }
  JsonValue record() const { return document_.root(); }
  const std::optional<pipeline::RunContents>& contents() const { return contents_; }
  bool has_figures() const { return fs::exists(folder_.evaluation()); }
  std::string text(const char* key) const { return record()[key].text(); }

  /// Where it is; empty if it is not there.
  fs::path recording() const {
    const fs::path found = pipeline::find_recording(folder_, record());
    std::error_code failure;
    return fs::exists(found, failure) ? found : fs::path();
  }

  std::size_t files() const {
    const auto all = folder_.files();
    return static_cast<std::size_t>(std::count_if(
        all.begin(), all.end(), [](const fs::path& file) { return fs::exists(file); }));
  }

 private:
  pipeline::RunFolder folder_;
  files::JsonDocument document_;
  std::optional<pipeline::RunContents> contents_;
};

std::string recording_line(const LookedAtRun& run) {
  const JsonValue recording = run.record()["recording"];
  const fs::path there = run.recording();
  return fmt::format(
      "{} ({}), {}", recording["name"].text(), recording["format"].text(),
      there.empty() ? recording["path"].text() + ", which is not there" : there.string());
}

std::string frames_line(const LookedAtRun& run) {
  const JsonValue frames = run.record()["frames"];
  std::string text = fmt::format("{} estimated", frames["used"].count());
  for (const std::string& reason : frames["skipped"].keys()) {
    text += fmt::format("; {} skipped: {}", frames["skipped"][reason].count(), reason);
  }
  return text;
}

std::string configuration_line(const LookedAtRun& run) {
  const JsonValue settings = run.record()["configuration"]["settings"];
  std::string changed;
  for (std::size_t i = 0; i < settings.size(); ++i) {
    if (!settings[i]["changed"].boolean()) continue;
    changed += fmt::format("{}{}={}", changed.empty() ? ", " : " ", settings[i]["key"].text(),
                           settings[i]["value"].json_text());
  }
  return run.text("pipeline") + (changed.empty() ? ", as shipped" : changed);
}

void add_figures(const LookedAtRun& run, Table& table) {
  const evaluation::Evaluation& evaluation = run.contents()->evaluation;
  if (evaluation.comparison) {
    const char* name = "accuracy";
    for (const std::string& line :
         accuracy_lines(*evaluation.comparison, run.contents()->health.is_navigation)) {
      table.add_row({name, line});
      name = "";
    }
  } else {
    const JsonValue error = run.record()["evaluation_error"];
    table.add_row({"reference", error.is_null() ? "none" : "not compared: " + error.text()});
  }
  if (evaluation.consistency) {
    table.add_row(
        {"map", fmt::format("entropy (MME) {:.3f}, {} points", evaluation.consistency->mme,
                            run.record()["map"]["points"].count())});
  }
  const JsonValue timing = run.record()["timing_ms"];
  if (timing.is_null()) {
    table.add_row({"time", "not known: another program made the poses"});
    return;
  }
  const JsonValue threads = run.record()["threads"];
  table.add_row({"time", fmt::format("{:.1f} ms per frame (median), {:.1f} ms at 95 %, {} thread{}",
                                     timing["frame_median"].number(), timing["frame_p95"].number(),
                                     threads.is_null() ? "?" : std::to_string(threads.count()),
                                     !threads.is_null() && threads.count() == 1 ? "" : "s")});
}

/// What can be done with it.
std::vector<std::string> next_commands(const LookedAtRun& run) {
  const pipeline::RunFolder& folder = run.folder();
  const std::string name = folder.path.string();
  if (!run.contents()) return {fmt::format("traverse run RECORDING -o {}", name)};
  std::vector<std::string> commands{
      fmt::format("traverse report {}", name),
      fmt::format("traverse-replay {}{}", name,
                  run.recording().empty() ? " --moved-to RECORDING" : ""),
      fmt::format("traverse compare {} OTHER_RUN", name)};
  if (fs::exists(folder.keyframes()) || fs::exists(folder.simple_map())) {
    commands.push_back(fmt::format("traverse map {} -o MAP", name));
  }
  if (fs::exists(folder.keyframes())) {
    commands.push_back(
        fmt::format("traverse localize OTHER_RECORDING --map {} -o OTHER_RUN", name));
  }
  return commands;
}

}  // namespace

bool is_run_folder(const fs::path& folder) {
  std::error_code failure;
  return fs::is_regular_file(pipeline::RunFolder{folder}.record(), failure);
}

std::string run_text(const fs::path& folder) {
  const LookedAtRun run(folder);
  Table table({{}, {Table::Align::kLeft, 100}});
  const std::string reason = run.text("reason");
  table.add_row({"status", run.text("status") + (reason.empty() ? "" : ": " + reason)});
  table.add_row({"recording", recording_line(run)});
  table.add_row({"pipeline", configuration_line(run)});
  table.add_row({"frames", frames_line(run)});
  if (run.contents() && run.has_figures()) add_figures(run, table);
  table.add_row({"made", fmt::format("{}, Traverse {}", run.text("started_utc"),
                                     run.record()["program"]["version"].text())});
  const bool has_digests = run.record().has("files");
  table.add_row({"files", fmt::format("{}, {}", run.files(),
                                      has_digests ? "as the run wrote them"
                                                  : "of a version that wrote no digests of them")});
  std::string text = fmt::format("{}: a run\n", folder.string()) + table.text(2) + "\nNext\n";
  for (const std::string& command : next_commands(run)) text += "  " + command + "\n";
  return text;
}

std::string run_json(const fs::path& folder) {
  const LookedAtRun run(folder);
  ordered_json json{{"run", folder.string()},
                    {"status", run.text("status")},
                    {"reason", run.text("reason")},
                    {"pipeline", run.text("pipeline")},
                    {"recording", run.record()["recording"]["name"].text()},
                    {"recording_path", nullptr},
                    {"frames", run.record()["frames"]["used"].count()}};
  if (!run.recording().empty()) json["recording_path"] = run.recording().string();
  json["figures"] = ordered_json::object();
  if (run.contents() && run.has_figures()) {
    const evaluation::Evaluation& evaluation = run.contents()->evaluation;
    ordered_json& figures = json["figures"];
    if (evaluation.comparison) {
      for (const auto& ape : evaluation.comparison->ape) {
        if (ape.relation != evaluation::Relation::kTranslation) continue;
        figures["ape_rmse_m"] = ape.statistics.rmse;
      }
      figures["end_error_m"] = evaluation.comparison->path.end_error_m;
      if (const auto& kitti = evaluation.comparison->kitti) {
        figures["kitti_translation_percent"] = kitti->translation_percent;
      }
    }
    if (evaluation.consistency) figures["map_entropy_nats"] = evaluation.consistency->mme;
    if (const JsonValue timing = run.record()["timing_ms"]; !timing.is_null()) {
      figures["frame_median_ms"] = timing["frame_median"].number();
    }
  }
  json["next"] = next_commands(run);
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace traverse::app
