#include <algorithm>
#include <array>
#include <span>
#include <string>

#include <fmt/format.h>

#include "charts/navigation_series.hpp"
#include "run/number_texts.hpp"
#include "sections/budget_check.hpp"
#include "sections/sections.hpp"

namespace traverse::report {

namespace {

constexpr std::size_t kMostHeadlines = 6;
constexpr std::size_t kMostNavigationHeadlines = 8;

/// In the order of importance; the first six that the run defines are shown.
constexpr std::array<std::string_view, 7> kHeadlines{
    "kitti_translation_percent", "ape_rmse_m",      "closing_error_m", "rpe_10_frames_rmse_m",
    "map_entropy_nats",          "frame_median_ms", "frame_p95_ms"};
/// Of a run that fixes hold: what it is worth is how far it is off, with them and without.
constexpr std::array<std::string_view, 10> kNavigationHeadlines{
    "ape_rmse_m",      "outage_error_rms_m", "jump_p95_m",      "jump_max_m",
    "roughness_m",     "ape_angle_rmse_deg", "closing_error_m", "rpe_10_frames_rmse_m",
    "frame_median_ms", "frame_p95_ms"};

std::string interval_text(const RunFigure& figure) {
  if (!figure.interval) return figure.no_interval;
  return fmt::format("{} to {} ({}\u00a0%, blocks of {})", short_number(figure.interval->low),
                     short_number(figure.interval->high), 100 * figure.interval->confidence,
                     figure.interval->block_length);
}

Json interval_json(const RunFigure& figure) {
  if (!figure.interval) return nullptr;
  return {{"low", figure.interval->low},
          {"high", figure.interval->high},
          {"confidence", figure.interval->confidence},
          {"block_length", figure.interval->block_length},
          {"resamples", figure.interval->resamples},
          {"how", "percentiles of the moving-block bootstrap"}};
}

const BudgetLine* find_line(const BudgetResult* budget, const std::string& figure) {
  if (budget == nullptr) return nullptr;
  const auto found = std::find_if(budget->lines.begin(), budget->lines.end(),
                                  [&](const BudgetLine& line) { return line.figure == figure; });
  return found == budget->lines.end() ? nullptr : &*found;
}

TemplateData headline(const RunFigure& figure, const BudgetResult* budget) {
  TemplateData entry;
  entry.set("id", figure.id);
  entry.set("label", figure.label);
  entry.set("value", short_number(figure.value));
  entry.set("full", full_number(figure.value));
  entry.set("unit", figure.unit);
  entry.set("how", figure.how);
  entry.set("interval", interval_text(figure));
  entry.set("interval_full", figure.interval ? TemplateData(fmt::format(
                                                   "{} to {}", full_number(figure.interval->low),
                                                   full_number(figure.interval->high)))
                                             : TemplateData(false));
  const BudgetLine* line = find_line(budget, figure.id);
  entry.set("budget", line != nullptr);
  if (line != nullptr) {
    entry.set("budget_kind", line->passed() ? "good" : "fail");
    entry.set("budget_word", fmt::format("{}, {} {}", line->passed() ? "✓ pass" : "✗ fail",
                                         line->limit_words(), short_number(line->limit)));
  }
  return entry;
}

}  // namespace

void add_headlines(const RunData& run, const std::vector<RunFigure>& figures,
                   const BudgetResult* budget, Model& model) {
  Json json = Json::object();
  for (const RunFigure& figure : figures) {
    json[figure.id] = {
        {"label", figure.label},
        {"value", figure.value},
        {"unit", figure.unit},
        {"how", figure.how},
        {"interval", interval_json(figure)},
        {"no_interval", figure.no_interval.empty() ? Json() : Json(figure.no_interval)}};
  }
  model.json["figures"] = std::move(json);

  TemplateData list = TemplateData::list();
  std::size_t shown = 0;
  const bool of_navigation = is_navigation(run.frames);
  const std::size_t most = of_navigation ? kMostNavigationHeadlines : kMostHeadlines;
  const std::span<const std::string_view> ids =
      of_navigation ? std::span<const std::string_view>(kNavigationHeadlines) : kHeadlines;
  for (const std::string_view id : ids) {
    const RunFigure* figure = find_figure(figures, id);
    if (figure == nullptr || shown == most) continue;
    list.push_back(headline(*figure, budget));
    ++shown;
  }
  model.page.set("headlines", list);
}

}  // namespace traverse::report
