#include "traverse/report/budget.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "traverse/config/document.hpp"
#include "traverse/files/input_error.hpp"

#include "charts/series.hpp"
#include "run/number_texts.hpp"
#include "sections/budget_check.hpp"

namespace traverse::report {

namespace {

/// What figures were called up to version 0.1, when the closing error was called drift.
constexpr std::array<std::pair<std::string_view, std::string_view>, 2> kFormerNames{
    {{"end_drift_percent", "closing_error_percent"}, {"end_error_m", "closing_error_m"}}};

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

struct Limits {
  std::map<std::string_view, double> at_most;
  bool is_private = false;
};

Limits read_limits(const std::filesystem::path& file) {
  Limits read;
  auto& limits = read.at_most;
  for (const FigureKind& kind : figure_kinds()) limits[kind.id] = kNoLimit;
  config::read(config::Document::load(file), [&](config::Binder& binder) {
    for (const FigureKind& kind : figure_kinds()) {
      binder.number(kind.id, limits[kind.id], config::Range::any(), kind.meaning);
    }
    for (const auto& [former, id] : kFormerNames) {
      binder.number(former, limits[id], config::Range::any(), "up to version 0.1");
    }
    binder.flag("private", read.is_private, "pages do not tell whose machine made the run");
  });
  return read;
}

std::string value_text(const BudgetLine& line) {
  return line.value ? short_number(*line.value) : "not defined";
}

}  // namespace

bool BudgetResult::passed() const {
  return std::all_of(lines.begin(), lines.end(),
                     [](const BudgetLine& line) { return line.passed(); });
}

std::string BudgetResult::table() const {
  std::string text;
  for (const BudgetLine& line : lines) {
    text += fmt::format("{}  {:<28}{} {}{}{} {}\n", line.passed() ? "pass" : "FAIL", line.figure,
                        value_text(line), line.unit, line.unit.empty() ? "" : ", ",
                        line.limit_words(), short_number(line.limit));
  }
  const auto failed = std::count_if(lines.begin(), lines.end(),
                                    [](const BudgetLine& line) { return !line.passed(); });
  text += failed == 0 ? fmt::format("budget {}: kept\n", file.string())
                      : fmt::format("budget {}: {} of {} limits not kept\n", file.string(), failed,
                                    lines.size());
  return text;
}

BudgetResult check_figures(const std::filesystem::path& file,
                           const std::vector<RunFigure>& figures) {
  const Limits limits = read_limits(file);
  BudgetResult result;
  result.file = file;
  result.is_private = limits.is_private;
  for (const FigureKind& kind : figure_kinds()) {
    const double limit = limits.at_most.at(kind.id);
    if (limit == kNoLimit) continue;
    BudgetLine line{std::string(kind.id),   std::string(kind.label),
                    std::string(kind.unit), limit,
                    kind.higher_is_better,  std::nullopt};
    if (const RunFigure* found = find_figure(figures, kind.id)) line.value = found->value;
    result.lines.push_back(std::move(line));
  }
  if (result.lines.empty()) {
    throw files::InputError(file, files::Place::whole_file(), "a limit for at least one figure",
                            "none");
  }
  return result;
}

bool require_valid_budget(const std::filesystem::path& budget) {
  return check_figures(budget, {}).is_private;
}

BudgetResult check_budget(const std::filesystem::path& budget,
                          const std::filesystem::path& run_folder) {
  return check_figures(budget, run_figures(read_run(run_folder, pipeline::RunPart::kFigures)));
}

BudgetResult check_budget(const std::filesystem::path& budget,
                          const evaluation::Evaluation& evaluation) {
  return check_figures(budget, accuracy_figures(evaluation));
}

void add_budget(const BudgetResult& result, Model& model) {
  Table table("budget", "Budget " + result.file.filename().string(),
              {"figure", "value", "limit is", "limit", "unit", "kept"});
  for (const BudgetLine& line : result.lines) {
    table.add_row({line.label, line.value ? Cell(*line.value) : Cell(kNone), line.limit_words(),
                   line.limit, line.unit, line.passed() ? "pass" : "fail"});
  }
  model.add_table(table);
  model.json["budget_kept"] = result.passed();
}

}  // namespace traverse::report
