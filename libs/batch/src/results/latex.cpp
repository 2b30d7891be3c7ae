#include "traverse/files/latex.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/batch/metric.hpp"

#include "results/summary.hpp"

namespace traverse::batch {

namespace {

struct Column {
  std::string head;
  std::vector<double> values;  ///< a variant; NaN where there is none
  bool lower_is_better = true;
};

Column mean_column(const std::vector<VariantSummary>& variants, const Metric& metric) {
  Column column{metric.title + (metric.unit.empty() ? "" : " [" + metric.unit + "]"),
                {},
                metric.lower_is_better};
  for (const VariantSummary& variant : variants) {
    const auto mean = variant.means.find(metric.key);
    column.values.push_back(mean == variant.means.end() ? std::numeric_limits<double>::quiet_NaN()
                                                        : mean->second);
  }
  return column;
}

Column kitti_column(const std::vector<VariantSummary>& variants, const std::string& head,
                    double KittiAverages::*average) {
  Column column{head, {}, true};
  for (const VariantSummary& variant : variants) {
    column.values.push_back(variant.kitti ? (*variant.kitti).*average
                                          : std::numeric_limits<double>::quiet_NaN());
  }
  return column;
}

std::vector<Column> columns_of(const std::vector<VariantSummary>& variants,
                               const std::vector<std::string>& metrics) {
  std::vector<Column> columns;
  for (const std::string& key : metrics) {
    if (key == "kitti_translation_percent") {
      columns.push_back(kitti_column(variants, "KITTI drift, all segments [%]",
                                     &KittiAverages::translation_all_segments_percent));
      columns.push_back(kitti_column(variants, "KITTI drift, mean of recordings [%]",
                                     &KittiAverages::translation_per_recording_percent));
    } else if (key == "kitti_rotation_deg_per_m") {
      columns.push_back(kitti_column(variants, "KITTI rotation, all segments [deg/m]",
                                     &KittiAverages::rotation_all_segments_deg_per_m));
      columns.push_back(kitti_column(variants, "KITTI rotation, mean of recordings [deg/m]",
                                     &KittiAverages::rotation_per_recording_deg_per_m));
    } else if (const Metric* metric = find_metric(key)) {
      columns.push_back(mean_column(variants, *metric));
    }
  }
  return columns;
}

/// Three significant digits; the best of its column in bold.
std::string cell(const Column& column, std::size_t row) {
  const double value = column.values[row];
  if (!std::isfinite(value)) return "--";
  std::string text = fmt::format("{:#.3g}", value);
  if (text.ends_with('.')) text.pop_back();
  bool is_best = column.lower_is_better;
  for (const double other : column.values) is_best = is_best && !(other < value);
  return is_best ? "\\textbf{" + text + "}" : text;
}

}  // namespace

std::string leaderboard_latex(const std::vector<VariantSummary>& variants,
                              const std::vector<std::string>& metrics) {
  const std::vector<Column> columns = columns_of(variants, metrics);
  std::string text = "% Needs \\usepackage{booktabs}. Means over recordings of runs that are ok.\n";
  text += "\\begin{tabular}{lr" + std::string(columns.size(), 'r') + "}\n\\toprule\n";
  text += "Pipeline & Runs ok";
  for (const Column& column : columns) text += " & " + files::latex_text(column.head);
  text += " \\\\\n\\midrule\n";
  for (std::size_t row = 0; row < variants.size(); ++row) {
    text += fmt::format("{} & {}/{}", files::latex_text(variants[row].variant), variants[row].ok,
                        variants[row].runs);
    for (const Column& column : columns) text += " & " + cell(column, row);
    text += " \\\\\n";
  }
  return text + "\\bottomrule\n\\end{tabular}\n";
}

}  // namespace traverse::batch
