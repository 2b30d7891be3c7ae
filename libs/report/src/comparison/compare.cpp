#include "traverse/report/compare.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/page/html_page.hpp"
#include "traverse/render/pictures/trajectory_from_above.hpp"
#include "traverse/render/renderer.hpp"

#include "charts/series.hpp"
#include "comparison/comparison.hpp"
#include "figures/fixes_beside.hpp"
#include "page/data_uri.hpp"
#include "run/number_texts.hpp"

namespace traverse::report {

namespace {

namespace fs = std::filesystem;

/// What a recording is known by: its digest, or its name where none was computed.
std::string identity(const RunData& run) {
  const auto& recording = run.record.at("recording");
  return recording.at("sha256").is_null() ? run.recording_name()
                                          : recording.at("sha256").get<std::string>();
}

void require_same_recording(const ComparedRun& baseline, const ComparedRun& run) {
  const bool both_hashed = !baseline.data.record.at("recording").at("sha256").is_null() &&
                           !run.data.record.at("recording").at("sha256").is_null();
  const bool same = both_hashed ? identity(baseline.data) == identity(run.data)
                                : baseline.data.recording_name() == run.data.recording_name();
  if (same) return;
  throw files::InputError(run.data.folder.record(), files::Place::key("recording"),
                          "a run of the recording of " + baseline.data.folder.path.string() + ", " +
                              baseline.data.recording_name(),
                          run.data.recording_name());
}

std::vector<ComparedRun> read_runs(const std::vector<fs::path>& folders) {
  std::vector<ComparedRun> runs;
  for (const fs::path& folder : folders) {
    const fs::path plain = folder.has_filename() ? folder : folder.parent_path();
    std::string name = plain.filename().string();
    const bool taken = std::any_of(folders.begin(), folders.end(), [&](const fs::path& other) {
      return other != folder &&
             (other.has_filename() ? other : other.parent_path()).filename() == plain.filename();
    });
    if (taken) name = plain.string();
    ComparedRun run{std::move(name), read_run(folder, pipeline::RunPart::kFigures), {}};
    run.figures = run_figures(run.data);
    runs.push_back(std::move(run));
    require_same_recording(runs.front(), runs.back());
  }
  return runs;
}

/// Runs whose pages may not tell whose machine made them go by their folders' names alone; equal
/// ones are numbered.
void make_private(std::vector<ComparedRun>& runs, bool all) {
  for (ComparedRun& run : runs) {
    if (all || run.data.is_private()) make_private(run.data, run.data.folder.path);
  }
  std::map<std::string, std::size_t> times;
  for (ComparedRun& run : runs) {
    if (!run.data.is_private()) continue;
    const std::string name = run.data.folder.path.string();
    const std::size_t number = ++times[name];
    run.name = number == 1 ? name : fmt::format("{} ({})", name, number);
  }
}

/// All ways over the reference, light and dark, as data URIs.
std::pair<std::string, std::string> draw_overlay(const std::vector<ComparedRun>& runs) {
  std::vector<geometry::Trajectory> ways;
  for (const ComparedRun& run : runs) ways.push_back(aligned_estimate(run.data));
  std::vector<render::NamedTrajectory> named;
  for (std::size_t k = 0; k < runs.size(); ++k) named.push_back({runs[k].name, &ways[k]});
  std::vector<const RunData*> all;
  for (const ComparedRun& run : runs) all.push_back(&run.data);
  const render::BesideTrajectories beside = fixes_beside(all);
  const RunData& first = runs.front().data;
  const geometry::Trajectory* reference =
      first.reference && first.evaluation.comparison ? &*first.reference : nullptr;
  const render::Caption caption{
      "Trajectories from above",
      plural(runs.size(), "run") + (reference != nullptr ? ", each aligned to the reference" : ""),
      first.recording_name(), "", first.date()};
  render::Renderer renderer;
  render::Style style;
  const auto draw = [&] {
    return data_uri(
        "image/png",
        renderer.render(render::trajectory_from_above(named, reference, caption, style, beside))
            .encode_png());
  };
  std::string light = draw();
  style.theme = render::dark_theme();
  return {std::move(light), draw()};
}

/// How a run's figures differ from the baseline's.
struct Changes {
  std::string run;
  std::vector<std::string> improved;  ///< "APE"
  std::vector<std::string> regressed;
};

/// "2 improved (APE; Roughness)"; of one of many runs without the names.
std::string counted(const std::vector<std::string>& figures, const char* verdict, bool with_names) {
  std::string text = fmt::format("{} {}", figures.size(), verdict);
  if (with_names) text += fmt::format(" ({})", fmt::join(figures, "; "));
  return text;
}

/// "b: 2 improved (APE; Roughness), 1 regressed (Time per frame). 3 figures without a change that
/// is sure."; of more than two runs only how many: "b: 1 improved, 2 regressed; c: nothing changed.
/// ..."
std::string sentence(const Json& differences) {
  std::vector<Changes> runs;
  std::size_t unchanged = 0;
  for (const Json& row : differences.at("rows")) {
    const auto name = row[0].get<std::string>();
    const auto verdict = row.back().get<std::string>();
    if (runs.empty() || runs.back().run != name) runs.push_back({name, {}, {}});
    const bool improved = verdict == "improved";
    if (!improved && verdict != "regressed") {
      ++unchanged;
      continue;
    }
    Changes& changes = runs.back();
    (improved ? changes.improved : changes.regressed).push_back(row[1].get<std::string>());
  }
  std::vector<std::string> sentences;
  for (const Changes& run : runs) {
    const bool with_names = runs.size() == 1;
    std::vector<std::string> counts;
    if (!run.improved.empty()) counts.push_back(counted(run.improved, "improved", with_names));
    if (!run.regressed.empty()) counts.push_back(counted(run.regressed, "regressed", with_names));
    if (counts.empty()) counts.emplace_back("nothing changed");
    sentences.push_back(fmt::format("{}: {}", run.run, fmt::join(counts, ", ")));
  }
  std::string text;
  if (!sentences.empty()) text = fmt::format("{}.", fmt::join(sentences, "; "));
  if (unchanged > 0) {
    text += fmt::format(" {} without a change that is sure.", plural(unchanged, "figure"));
  }
  return text;
}

/// What must be known of the runs before their figures: "b is lost: 0 of 23 frames ..."
std::string health_words(const std::vector<ComparedRun>& runs) {
  std::string text;
  for (const ComparedRun& run : runs) {
    const pipeline::RunHealth& health = run.data.health;
    if (health.reasons.empty()) continue;
    text += fmt::format("{} is {}: {} ", run.name, pipeline::name_of(health.verdict),
                        health.reasons.front().text);
  }
  return text;
}

/// The page and its numbers are replaced only where an earlier comparison stands.
void require_own(const fs::path& page, const fs::path& numbers) {
  std::error_code failure;
  if (fs::is_regular_file(page, failure)) {
    const std::string text = files::read_text(page);
    const auto generator = text.find("name=\"generator\" content=\"Traverse");
    if (generator != std::string::npos) return;
    throw files::OutputError(page,
                             "it is there already and no page of this program. Choose another name "
                             "with -o");
  }
  if (fs::is_regular_file(numbers, failure)) {
    throw files::OutputError(numbers,
                             "it is there already, without a page of this program beside "
                             "it. Choose another name with -o");
  }
}

}  // namespace

std::string write_comparison(const std::vector<fs::path>& folders, const fs::path& page,
                             const fs::path& templates, const CompareOptions& options) {
  if (folders.size() < 2) throw std::invalid_argument("a comparison needs two runs or more");
  fs::path numbers = page;
  numbers.replace_extension(".json");
  require_own(page, numbers);
  std::vector<ComparedRun> runs = read_runs(folders);
  make_private(runs, options.is_private);
  Model model;
  model.json["schema"] = "traverse/comparison/1";
  model.add_text("recording", runs.front().data.recording_name());
  model.add_text("baseline", runs.front().name);
  model.json["threshold_percent"] = options.threshold_percent;
  model.page.set("threshold", short_number(options.threshold_percent));
  model.add_text("program_version",
                 runs.front().data.record.at("program").at("version").get<std::string>());
  Json names = Json::array();
  for (const ComparedRun& run : runs) {
    names.push_back({{"name", run.name},
                     {"folder", run.data.folder.path.string()},
                     {"pipeline", run.data.pipeline_name()},
                     {"status", pipeline::name_of(run.data.health.verdict)},
                     {"reason", run.data.health.summary()}});
  }
  model.json["runs"] = std::move(names);

  for (Table& table : comparison_tables(runs, options.threshold_percent)) {
    model.add_table(std::move(table));
  }
  model.add_text("verdict", health_words(runs) + sentence(model.json["tables"]["differences"]));
  add_comparison_charts(runs, model);
  const auto [light, dark] = draw_overlay(runs);
  model.page.set("overlay_light", light);
  model.page.set("overlay_dark", dark);

  page::HtmlPage shown;
  shown.kind = "compare";
  shown.title = "Comparison · " + model.text("recording");
  shown.program_version = model.text("program_version");
  shown.sections = {{"verdict", "Verdict"},
                    {"trajectories", "Trajectories"},
                    {"errors", "Errors and time"},
                    {"stretches", "Stretches"},
                    {"settings", "Settings"}};
  shown.report_json = script_text(model.json);
  shown.scripts = {"dygraphs", "moment", "plot", "charts", "tables"};
  files::AtomicFiles output;
  output.write(numbers, shown.report_json + "\n");
  output.write(page, page::render(shown, model.page, templates));
  output.commit();
  std::string text;
  for (const Table& table : model.tables) {
    const bool told =
        table.id() == "figures" || table.id() == "differences" || table.id() == "wins";
    if (told && !table.empty()) text += page::to_text(table) + "\n";
  }
  return text + fmt::format("{}\n", model.text("verdict"));
}

}  // namespace traverse::report
