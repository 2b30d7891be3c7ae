#include <fmt/format.h>

#include "traverse/evaluation/titles.hpp"

#include "run/number_texts.hpp"
#include "sections/sections.hpp"

namespace traverse::report {

namespace {

using evaluation::Relation;

std::string relation_text(Relation relation) {
  const std::string_view unit = evaluation::unit_of(relation);
  return fmt::format("{}{}", evaluation::title_of(relation),
                     unit.empty() ? "" : fmt::format(" [{}]", unit));
}

void add_statistics(std::vector<Cell>& cells, const evaluation::Statistics& s) {
  for (const double value : {s.rmse, s.mean, s.median, s.std, s.min, s.max}) {
    cells.emplace_back(value);
  }
  cells.push_back(Cell::count(s.count));
}

Table ape_table(const evaluation::Comparison& comparison) {
  Table table("ape", "Absolute pose error",
              {"relation", "rmse", "mean", "median", "std", "min", "max", "pairs"});
  const auto add = [&](const evaluation::Ape& ape, const std::string& alignment) {
    std::vector<Cell> cells{relation_text(ape.relation) + alignment};
    add_statistics(cells, ape.statistics);
    table.add_row(std::move(cells));
  };
  for (const evaluation::Ape& ape : comparison.ape) add(ape, "");
  for (const evaluation::Ape& ape : comparison.ape_at_origin) add(ape, ", first poses aligned");
  return table;
}

Table split_table(const evaluation::ErrorSplit& split) {
  Table table("error_split", "Position error by direction",
              {"direction", "rmse [m]", "mean [m]", "largest [m]"});
  const auto add = [&](const char* name, const evaluation::ErrorPart& part) {
    table.add_row({name, part.rmse_m, part.mean_m, part.max_m});
  };
  add("along the path", split.along);
  add("across, to the left", split.across);
  add("up", split.up);
  return table;
}

/// The two relations that people ask for, or all the others.
Table rpe_table(const evaluation::Comparison& comparison, bool main_relations) {
  Table table(main_relations ? "rpe" : "rpe_more",
              main_relations ? "Relative pose error" : "Relative pose error, other relations",
              {"stretch", "relation", "rmse", "mean", "median", "std", "min", "max", "pairs"});
  for (const evaluation::Rpe& rpe : comparison.rpe) {
    const bool main = rpe.relation == Relation::kTranslation || rpe.relation == Relation::kAngleDeg;
    if (main != main_relations) continue;
    std::vector<Cell> cells{evaluation::describe(rpe.options), relation_text(rpe.relation)};
    add_statistics(cells, rpe.statistics);
    table.add_row(std::move(cells));
  }
  return table;
}

Table kitti_table(const evaluation::KittiDrift& kitti, const std::string& id, const std::string& by,
                  const std::vector<evaluation::KittiBin>& bins) {
  Table table(id, "KITTI drift by " + by,
              {by, "translation [%]", "rotation [deg/100 m]", "segments"});
  for (const evaluation::KittiBin& bin : bins) {
    table.add_row({bin.centre, bin.translation_percent, 100 * bin.rotation_deg_per_m,
                   Cell::count(bin.segments)});
  }
  Cell all("all");
  all.numeric = true;
  table.add_row({all, kitti.translation_percent, 100 * kitti.rotation_deg_per_m,
                 Cell::count(kitti.segments.size())},
                true);
  return table;
}

Table sub_trajectories_table(const evaluation::Comparison& comparison) {
  Table table("sub_trajectories", "Relative error by length of the stretch",
              {"length [m]", "translation, mean [%]", "median [%]", "max [%]", "mean [m]",
               "rotation, mean [deg]", "mean [deg/100 m]", "yaw, mean [deg]",
               "pitch and roll, mean [deg]", "stretches"});
  for (const evaluation::SubTrajectoryErrors& errors : comparison.sub_trajectories) {
    const auto& percent = errors.translation_percent;
    table.add_row({errors.length_m, percent.mean, percent.median, percent.max,
                   errors.translation_m.mean, errors.rotation_deg.mean,
                   100 * errors.rotation_deg_per_m.mean, errors.yaw_deg.mean,
                   errors.gravity_deg.mean, Cell::count(percent.count)});
  }
  return table;
}

Table path_table(const evaluation::PathFigures& path) {
  Table table("path", "Path", {"figure", "value", "unit"});
  table.add_row({"path of the estimate", path.estimate_m, "m"});
  table.add_row({"path of the reference", path.reference_m, "m"});
  table.add_row({"closing error", path.end_error_m, "m"});
  if (path.end_error_percent) table.add_row({"closing error", *path.end_error_percent, "%"});
  table.add_row({"end rotation", path.end_rotation_deg, "deg"});
  return table;
}

Table consistency_table(const evaluation::Consistency& score) {
  Table table("consistency", "Sharpness of the map", {"figure", "value", "unit", "over"});
  const std::string queries = count_text(score.queries) + " queries";
  table.add_row({"mean map entropy (MME)", score.mme, "nats", queries});
  table.add_row({"mean plane deviation (MPV)", 100 * score.mpv_m, "cm", queries});
  if (const auto& planes = score.point_to_plane) {
    const std::string planar = count_text(planes->queries) + " planar queries";
    table.add_row({"distance to planes of other scans, mean", 100 * planes->mean_m, "cm", planar});
    table.add_row({"the same, median", 100 * planes->median_m, "cm", planar});
    table.add_row({"the same, 90 %", 100 * planes->p90_m, "cm", planar});
  }
  return table;
}

Table undefined_table(const evaluation::Comparison& comparison) {
  Table table("undefined", "Figures that the trajectories do not define", {"figure", "because"});
  for (const evaluation::Undefined& item : comparison.undefined) {
    table.add_row({item.metric, item.reason});
  }
  return table;
}

}  // namespace

void add_accuracy(const RunData& run, Model& model) {
  const evaluation::Comparison& comparison = *run.evaluation.comparison;
  std::string association = evaluation::describe(comparison.association);
  for (const std::string& warning : comparison.warnings) association += "; warning: " + warning;
  model.add_text("association", association);
  model.add_text("alignment", evaluation::describe(comparison.alignment, comparison.stamps.size()));
  model.add_table(ape_table(comparison));
  model.page.set("table_error_split", false);
  if (comparison.split) {
    model.add_table(split_table(*comparison.split));
    model.add_text("error_split_how", evaluation::split_title(comparison));
    model.add_text("error_split_note", evaluation::alternation_note(comparison));
  }
  model.add_table(rpe_table(comparison, true));
  model.add_table(rpe_table(comparison, false));
  model.add_table(path_table(comparison.path));
  model.add_text("path_how", evaluation::path_title(comparison));
  model.page.set("has_kitti", comparison.kitti.has_value());
  if (const auto& kitti = comparison.kitti) {
    model.add_table(kitti_table(*kitti, "kitti_by_length", "length [m]", kitti->by_length));
    model.add_table(kitti_table(*kitti, "kitti_by_speed", "speed [m/s]", kitti->by_speed));
    model.add_text("kitti_how", evaluation::title(*kitti));
  }
  model.page.set("has_sub_trajectories", !comparison.sub_trajectories.empty());
  if (!comparison.sub_trajectories.empty()) {
    model.add_table(sub_trajectories_table(comparison));
    model.add_text("sub_trajectories_how", evaluation::sub_trajectories_title(comparison));
  }
  model.add_table(undefined_table(comparison));
}

void add_map_sharpness(const RunData& run, Model& model) {
  const auto& score = run.evaluation.consistency;
  if (!score) return;
  model.add_table(consistency_table(*score));
  model.add_text("consistency_how", evaluation::title(*score));
}

}  // namespace traverse::report
