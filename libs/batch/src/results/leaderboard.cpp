#include <limits>

#include <fmt/format.h>

#include "traverse/batch/metric.hpp"

#include "results/summary.hpp"

namespace traverse::batch {

namespace {

struct BoardColumn {
  std::string head;
  std::vector<double> values;  ///< a variant; NaN where there is none
  bool lower_is_better = true;
};

BoardColumn mean_column(const std::vector<VariantSummary>& variants, const Metric& metric) {
  BoardColumn column{with_unit(metric), {}, metric.lower_is_better};
  for (const VariantSummary& variant : variants) {
    const auto mean = variant.means.find(metric.key);
    column.values.push_back(mean == variant.means.end() ? std::numeric_limits<double>::quiet_NaN()
                                                        : mean->second);
  }
  return column;
}

BoardColumn kitti_column(const std::vector<VariantSummary>& variants, const std::string& head,
                         double KittiAverages::*average) {
  BoardColumn column{head, {}, true};
  for (const VariantSummary& variant : variants) {
    column.values.push_back(variant.kitti ? (*variant.kitti).*average
                                          : std::numeric_limits<double>::quiet_NaN());
  }
  return column;
}

std::vector<BoardColumn> columns_of(const std::vector<VariantSummary>& variants,
                                    const std::vector<std::string>& metrics) {
  std::vector<BoardColumn> columns;
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

}  // namespace

page::Table leaderboard(const std::vector<VariantSummary>& variants,
                        const std::vector<std::string>& metrics) {
  const std::vector<BoardColumn> columns = columns_of(variants, metrics);
  std::vector<std::string> heads{"Pipeline", "Runs ok"};
  std::vector<std::size_t> ranked;
  for (const BoardColumn& column : columns) {
    if (column.lower_is_better) ranked.push_back(heads.size());
    heads.push_back(column.head);
  }
  page::Table table("leaderboard", "Means over recordings of runs that are ok", std::move(heads));
  for (std::size_t row = 0; row < variants.size(); ++row) {
    page::Cell ok(fmt::format("{}/{}", variants[row].ok, variants[row].runs));
    ok.numeric = true;
    std::vector<page::Cell> cells{variants[row].variant, std::move(ok)};
    for (const BoardColumn& column : columns) cells.emplace_back(column.values[row]);
    table.add_row(std::move(cells));
  }
  table.mark_best(ranked);
  return table;
}

}  // namespace traverse::batch
