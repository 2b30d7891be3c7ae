#include "traverse/batch/compare_runs.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "traverse/batch/metric.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/pipeline/privacy.hpp"
#include "traverse/pipeline/run_digests.hpp"
#include "traverse/pipeline/run_folder.hpp"

#include "results/lead.hpp"
#include "results/ranking.hpp"
#include "results/report.hpp"
#include "results/report_data.hpp"
#include "results/summary.hpp"

namespace traverse::batch {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// A run as it takes part.
struct ComparedRun {
  fs::path folder;
  Json record;
  std::string recording;  ///< what it is known by: its digest, or its name
  std::vector<MetricValue> metrics;

  bool is_foreign() const { return record.at("estimator") == "imported_poses"; }
};

Json read_record(const fs::path& folder) {
  const pipeline::RunFolder run{folder};
  pipeline::require_as_written(run, {run.record()});
  try {
    return Json::parse(files::read_text(run.record()));
  } catch (const Json::exception& error) {
    throw files::InputError(run.record(), files::Place::whole_file(), "the record of a run",
                            error.what());
  }
}

std::string recording_of(const Json& record) {
  const Json& recording = record.at("recording");
  return recording.at(recording.at("sha256").is_null() ? "name" : "sha256").get<std::string>();
}

ComparedRun read_compared(const fs::path& folder) {
  const pipeline::RunFolder run{folder};
  ComparedRun compared{folder, read_record(folder), {}, {}};
  pipeline::require_as_written(run, {run.evaluation(), run.frames(), run.trajectory()});
  try {
    compared.recording = recording_of(compared.record);
    compared.metrics = read_metrics(folder);
    for (const auto& [key, metric] :
         {std::pair{"wall_seconds", "wall_s"}, std::pair{"peak_memory_mb", "peak_memory_mb"}}) {
      const Json& value = compared.record.at(key);
      if (value.is_number()) compared.metrics.emplace_back(metric, value.get<double>());
    }
    return compared;
  } catch (const Json::exception& error) {
    throw files::InputError(run.record(), files::Place::whole_file(), "the record of a run",
                            error.what());
  }
}

/// Settings that are not those of the preset, but the poses of an import, which are other ones on
/// each recording.
std::vector<std::string> changed_settings(const ComparedRun& run) {
  std::vector<std::string> settings;
  if (run.is_foreign()) return settings;
  for (const Json& setting : run.record.at("configuration").at("settings")) {
    if (!setting.at("changed").get<bool>()) continue;
    const Json& value = setting.at("value");
    settings.push_back(fmt::format("{}={}", setting.at("key").get<std::string>(),
                                   value.is_string() ? value.get<std::string>() : value.dump()));
  }
  return settings;
}

std::string setting_of(const ComparedRun& run, std::string_view key) {
  for (const Json& setting : run.record.at("configuration").at("settings")) {
    if (setting.at("key") != key) continue;
    const Json& value = setting.at("value");
    return value.is_string() ? value.get<std::string>() : value.dump();
  }
  return {};
}

/// Recordings of one name and other content are numbered.
std::map<std::string, std::string> names_of_recordings(const std::vector<ComparedRun>& runs) {
  std::map<std::string, std::string> names;
  std::map<std::string, std::size_t> times;
  for (const ComparedRun& run : runs) {
    if (names.contains(run.recording)) continue;
    const auto name = run.record.at("recording").at("name").get<std::string>();
    const std::size_t number = ++times[name];
    names[run.recording] = number == 1 ? name : fmt::format("{} ({})", name, number);
  }
  return names;
}

Outcome outcome_by_status(const std::string& status) {
  for (const auto& [name, outcome] : kOutcomeNames) {
    if (name == status) return outcome;
  }
  return Outcome::kFailed;  // interrupted
}

/// A path as a link on a page.
std::string as_link(const fs::path& path) {
  std::string link;
  for (const char c : path.generic_string()) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                          std::string_view("/._-~").find(c) != std::string_view::npos;
    link += is_plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return link;
}

/// Everything that the page is made of; what it refers to stays where it is.
struct Compared {
  std::vector<ComparedRun> runs;
  Plan plan;
  Results results{{}};
  std::map<std::string, std::size_t> run_of;  ///< by the job's id

  const ComparedRun& of(const Job& job) const { return runs[run_of.at(job.id)]; }
};

Completion completion_of(const ComparedRun& run, const Job& job) {
  Completion completion;
  completion.id = job.id;
  completion.outcome = outcome_by_status(run.record.at("status").get<std::string>());
  completion.reason = run.record.at("reason").is_null()
                          ? std::string()
                          : run.record.at("reason").get<std::string>();
  completion.metrics = run.metrics;
  completion.has_report = fs::exists(pipeline::RunFolder{run.folder}.report());
  const Json::json_pointer digest("/files/trajectory.tum/sha256");
  if (run.record.contains(digest)) {
    completion.trajectory_sha256 = run.record.at(digest).get<std::string>();
  }
  return completion;
}

/// The default metrics that any run has; the first that has a better ranks.
std::vector<std::string> metrics_of(const std::vector<ComparedRun>& runs) {
  std::vector<std::string> metrics;
  for (const std::string& key : default_metrics()) {
    const bool is_there = std::any_of(runs.begin(), runs.end(), [&](const ComparedRun& run) {
      return std::any_of(run.metrics.begin(), run.metrics.end(),
                         [&](const MetricValue& value) { return value.first == key; });
    });
    if (is_there) metrics.push_back(key);
  }
  if (metrics.empty()) metrics.emplace_back("frames_used");
  return metrics;
}

Compared gather_runs(const std::vector<fs::path>& folders, const fs::path& page,
                     const RunsComparisonOptions& options) {
  Compared compared;
  for (const fs::path& folder : folders) compared.runs.push_back(read_compared(folder));
  const auto names = names_of_recordings(compared.runs);
  std::set<std::string> own;  // of which poses of another program of that name are told apart
  for (const ComparedRun& run : compared.runs) {
    if (!run.is_foreign()) own.insert(run.record.at("pipeline").get<std::string>());
  }
  std::vector<Job> jobs;
  std::vector<Completion> completions;
  std::map<std::pair<std::string, std::string>, int> repeats;
  Plan& plan = compared.plan;
  plan.file = page;
  plan.is_private = options.is_private;
  for (const ComparedRun& run : compared.runs) {
    Job job;
    job.id = std::to_string(jobs.size());
    job.recording = names.at(run.recording);
    job.pipeline = run.record.at("pipeline").get<std::string>();
    if (run.is_foreign() && own.contains(job.pipeline)) job.pipeline += " (imported)";
    job.settings = changed_settings(run);
    job.repeat = ++repeats[{job.recording, job.variant()}];
    plan.is_private = plan.is_private || run.record.value("private", false);
    const auto has = [](const auto& list, const std::string& name) {
      return std::any_of(list.begin(), list.end(),
                         [&](const auto& one) { return one.name == name; });
    };
    if (!has(plan.recordings, job.recording)) {
      plan.recordings.emplace_back().name = job.recording;
    }
    if (!has(plan.pipelines, job.pipeline)) plan.pipelines.emplace_back().name = job.pipeline;
    compared.run_of[job.id] = jobs.size();
    completions.push_back(completion_of(run, job));
    jobs.push_back(std::move(job));
  }
  plan.metrics = metrics_of(compared.runs);
  compared.results = Results(std::move(jobs));
  for (Completion& completion : completions) compared.results.add(std::move(completion));
  return compared;
}

/// "body", or both where the runs of one variant differ.
std::string joined(const std::set<std::string>& texts) {
  return texts.empty() ? "–" : fmt::format("{}", fmt::join(texts, "; "));
}

/// What a run says of one thing that comparisons depend on.
std::string frame_of(const ComparedRun& run) {
  if (!run.is_foreign()) return "body";
  const std::string extrinsic = setting_of(run, "poses.extrinsic");
  return setting_of(run, "poses.frame") +
         (extrinsic.empty() || extrinsic == "[]" ? "" : ", with an extrinsic");
}

std::string machine_of(const ComparedRun& run, bool is_private) {
  const Json& host = run.record.at("host");
  if (run.is_foreign() || is_private || !host.is_object()) return {};
  return host.contains("cpu") && host["cpu"].is_string() ? host["cpu"].get<std::string>()
                                                         : std::string();
}

std::string threads_of(const ComparedRun& run) {
  const Json& threads = run.record.at("threads");
  return threads.is_number() ? threads.dump() : "not known";
}

std::string program_of(const ComparedRun& run) {
  if (run.is_foreign()) return "poses of another program";
  const Json& program = run.record.at("program");
  return fmt::format("the preset of Traverse {}, commit {}",
                     program.at("version").get<std::string>(),
                     program.at("commit").get<std::string>().substr(0, 12));
}

/// Of a recording, or of what the command line said about it.
std::string told_of(const ComparedRun& run) {
  std::vector<std::string> told = changed_settings(run);
  const Json& statements = run.record.at("recording").at("statements");
  if (statements.is_array()) {
    for (const Json& statement : statements) {
      // What it is compared with is the same for all, and stands elsewhere.
      if (statement.is_string() && statement.get<std::string>().starts_with("reference.")) continue;
      told.push_back(statement.is_string() ? statement.get<std::string>() : statement.dump());
    }
  }
  return told.empty() ? "nothing more" : fmt::format("{}", fmt::join(told, " "));
}

std::string alignment_of(const ComparedRun& run) {
  const auto figures = pipeline::RunFolder{run.folder}.evaluation();
  const Json evaluation = Json::parse(files::read_text(figures), nullptr, false);
  const Json::json_pointer how("/alignment/how");
  return evaluation.contains(how) && evaluation.at(how).is_string()
             ? evaluation.at(how).get<std::string>()
             : "no reference";
}

page::Table fairness_of(const Compared& compared) {
  const pipeline::Privacy privacy(fs::absolute(compared.plan.file).parent_path());
  const auto public_text = [&](const std::string& text) {
    return compared.plan.is_private ? privacy.text(text) : text;
  };
  page::Table table("fairness", "What each was told, and what its figures are of",
                    {"pipeline", "is", "poses of", "points of its map", "alignment",
                     "poses compared", "threads", "machine", "time and memory of", "told"});
  std::vector<std::string> order;
  std::map<std::string, std::vector<const ComparedRun*>> by_variant;
  for (const Job& job : compared.results.jobs()) {
    auto& runs = by_variant[job.variant()];
    if (runs.empty()) order.push_back(job.variant());
    runs.push_back(&compared.of(job));
  }
  for (const std::string& variant : order) {
    std::set<std::string> kinds, frames, points, alignments, threads, machines, told;
    double pairs = 0;
    double used = 0;
    bool has_times = false;
    for (const ComparedRun* run : by_variant.at(variant)) {
      kinds.insert(program_of(*run));
      frames.insert(frame_of(*run));
      const Json& treated = run->record.at("points_used");
      if (treated.is_string()) points.insert(treated.get<std::string>());
      alignments.insert(alignment_of(*run));
      threads.insert(threads_of(*run));
      const std::string machine = machine_of(*run, compared.plan.is_private);
      if (!machine.empty()) machines.insert(machine);
      told.insert(public_text(told_of(*run)));
      const std::map<std::string_view, double> values(run->metrics.begin(), run->metrics.end());
      if (values.contains("pairs") && values.contains("frames_used")) {
        pairs += values.at("pairs");
        used += values.at("frames_used");
      }
      has_times = has_times || values.contains("wall_s");
    }
    const bool is_foreign = by_variant.at(variant).front()->is_foreign();
    table.add_row({variant, joined(kinds), joined(frames), joined(points), joined(alignments),
                   used > 0 ? fmt::format("{:.1f} % of its frames", 100 * pairs / used) : "–",
                   joined(threads), joined(machines),
                   !has_times   ? "not known"
                   : is_foreign ? "what was told of that program"
                                : "the run, with its maps and evaluation",
                   joined(told)});
  }
  return table;
}

/// What stands at these places is replaced only where an earlier comparison wrote it.
void require_own_page(const fs::path& page, const std::vector<fs::path>& beside) {
  std::error_code failure;
  if (fs::is_regular_file(page, failure)) {
    if (files::read_text(page).find("name=\"generator\" content=\"Traverse") != std::string::npos) {
      return;
    }
    throw files::OutputError(page,
                             "it is there already and no page of this program. Choose another name "
                             "with -o");
  }
  for (const fs::path& file : beside) {
    if (!fs::is_regular_file(file, failure)) continue;
    throw files::OutputError(file,
                             "it is there already, without a page of this program beside it. "
                             "Choose another name with -o");
  }
}

}  // namespace

std::size_t count_recordings(const std::vector<fs::path>& run_folders) {
  std::set<std::string> recordings;
  for (const fs::path& folder : run_folders) {
    const Json record = read_record(folder);
    try {
      recordings.insert(recording_of(record));
    } catch (const Json::exception& error) {
      throw files::InputError(pipeline::RunFolder{folder}.record(), files::Place::whole_file(),
                              "the record of a run", error.what());
    }
  }
  return recordings.size();
}

std::string write_runs_comparison(const std::vector<fs::path>& run_folders, const fs::path& page,
                                  const RunsComparisonOptions& options) {
  if (run_folders.size() < 2) throw std::invalid_argument("a comparison needs two runs or more");
  fs::path numbers = page;
  numbers.replace_extension(".json");
  fs::path latex = page;
  latex.replace_extension(".tex");
  require_own_page(page, {numbers, latex});
  const Compared compared = gather_runs(run_folders, page, options);
  const Plan& plan = compared.plan;
  const Results& results = compared.results;
  const auto variants = summarise(results, {}, plan.metrics.front());
  const RunFolderOf folder_of = [&](const Job& job) { return compared.of(job).folder; };
  std::vector<Lead> leads;
  for (const std::string& metric : plan.metrics) {
    if (const auto lead = find_lead(metric, results, variants, folder_of)) leads.push_back(*lead);
  }
  const fs::path place = fs::absolute(page).parent_path();
  const auto link_of = [&](const Job& job) {
    if (plan.is_private) return std::string();
    const fs::path folder = fs::absolute(compared.of(job).folder).lexically_normal();
    std::string link = as_link(folder.lexically_relative(place.lexically_normal()));
    while (link.ends_with('/')) link.pop_back();
    return link;
  };
  const std::optional<BaselineComparison> baseline;
  const std::vector<ShownTable> tables;
  const ReportData data{plan,  results,         variants,  baseline, tables,
                        leads, options.command, folder_of, link_of,  fairness_of(compared)};
  const auto ranking = rank_variants(results, plan.metrics.front(), folder_of);
  files::AtomicFiles output;
  output.write(numbers, report_data_json(data, ranking) + "\n");
  output.write(latex, page::to_latex(leaderboard(variants, plan.metrics)));
  output.write(page, batch_page(data, options.templates));
  output.commit();
  std::string text;
  if (ranking) text = page::to_text(ranking_table(*ranking)) + "\n";
  if (!leads.empty()) text += to_text(leads.front()) + ".\n";
  return text;
}

}  // namespace traverse::batch
