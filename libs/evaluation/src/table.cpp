#include "traverse/evaluation/table.hpp"

#include <iterator>

#include <fmt/format.h>

#include "traverse/evaluation/titles.hpp"

namespace traverse::evaluation {

namespace {

using Text = fmt::memory_buffer;

template <typename... Arguments>
void line(Text& text, fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  fmt::format_to(std::back_inserter(text), format, std::forward<Arguments>(arguments)...);
  text.push_back('\n');
}

std::string poses_text(const TrajectoryFacts& facts) {
  return fmt::format("{}{}{} poses, {:.5g} m", facts.name, facts.name.empty() ? "" : ": ",
                     facts.poses, facts.path_m);
}

void statistics_head(Text& text, const std::string& title) {
  line(text, "\n{}", title);
  line(text, "  {:26}{:>11}{:>11}{:>11}{:>11}{:>11}{:>11}{:>11}{:>9}", "", "rmse", "mean", "median",
       "std", "min", "max", "sse", "count");
}

void statistics_row(Text& text, Relation relation, const Statistics& s) {
  const std::string_view unit = unit_of(relation);
  const std::string name = unit.empty() ? std::string(title_of(relation))
                                        : fmt::format("{} [{}]", title_of(relation), unit);
  line(text, "  {:26}{:11.5g}{:11.5g}{:11.5g}{:11.5g}{:11.5g}{:11.5g}{:11.5g}{:9}", name, s.rmse,
       s.mean, s.median, s.std, s.min, s.max, s.sse, s.count);
}

void add_ape(Text& text, const std::vector<Ape>& list, const std::string& alignment) {
  if (list.empty()) return;
  statistics_head(text, fmt::format("APE, {}, {}", alignment, kRuleOfApe));
  for (const Ape& ape : list) statistics_row(text, ape.relation, ape.statistics);
}

void add_reading(Text& text, const TrajectoryFacts& facts) {
  if (!facts.read_as.empty()) line(text, "{:13}read as {}", "", facts.read_as);
  for (const std::string& note : facts.notes) line(text, "{:13}note: {}", "", note);
}

void add_split(Text& text, const Comparison& comparison) {
  if (!comparison.split) return;
  line(text, "\n{}", split_title(comparison));
  line(text, "  {:26}{:>11}{:>11}{:>11}", "", "rmse", "mean", "max");
  const auto row = [&](const char* name, const ErrorPart& part) {
    line(text, "  {:26}{:11.5g}{:11.5g}{:11.5g}", name, part.rmse_m, part.mean_m, part.max_m);
  };
  row("along [m]", comparison.split->along);
  row("across, left [m]", comparison.split->across);
  row("up [m]", comparison.split->up);
  const std::string note = alternation_note(comparison);
  if (!note.empty()) line(text, "  {}", note);
}

void add_rpe(Text& text, const Comparison& comparison, const std::string& alignment) {
  std::string above;
  for (const Rpe& rpe : comparison.rpe) {
    const std::string title =
        fmt::format("RPE, {}, {}, {}", describe(rpe.options), alignment, kRuleOfRpe);
    if (title != above) statistics_head(text, title);
    above = title;
    statistics_row(text, rpe.relation, rpe.statistics);
    if (rpe.dropped_without_motion > 0) {
      line(text, "  {:26}{} pairs without motion of the reference left out", "",
           rpe.dropped_without_motion);
    }
  }
}

void add_kitti(Text& text, const KittiDrift& kitti) {
  line(text, "\n{}", title(kitti));
  line(text, "  {:26}{:>11}{:>11}{:>11}", "", "%", "deg/m", "segments");
  const auto row = [&](const std::string& name, double percent, double deg_per_m,
                       std::size_t segments) {
    line(text, "  {:26}{:11.5g}{:11.5g}{:11}", name, percent, deg_per_m, segments);
  };
  row("mean over all", kitti.translation_percent, kitti.rotation_deg_per_m, kitti.segments.size());
  for (const KittiBin& bin : kitti.by_length) {
    row(fmt::format("over {} m", bin.centre), bin.translation_percent, bin.rotation_deg_per_m,
        bin.segments);
  }
  for (const KittiBin& bin : kitti.by_speed) {
    row(fmt::format("near {} m/s", bin.centre), bin.translation_percent, bin.rotation_deg_per_m,
        bin.segments);
  }
}

void add_sub_trajectories(Text& text, const Comparison& comparison) {
  if (comparison.sub_trajectories.empty()) return;
  line(text, "\n{}", sub_trajectories_title(comparison));
  line(text, "  {:26}{:>11}{:>11}{:>11}{:>11}{:>11}{:>11}{:>11}", "mean (median of %)", "m", "%",
       "median", "deg", "deg/m", "yaw deg", "stretches");
  for (const SubTrajectoryErrors& errors : comparison.sub_trajectories) {
    line(text, "  {:26}{:11.5g}{:11.5g}{:11.5g}{:11.5g}{:11.5g}{:11.5g}{:11}",
         fmt::format("over {:g} m", errors.length_m), errors.translation_m.mean,
         errors.translation_percent.mean, errors.translation_percent.median,
         errors.rotation_deg.mean, errors.rotation_deg_per_m.mean, errors.yaw_deg.mean,
         errors.translation_m.count);
  }
}

void add_path(Text& text, const Comparison& comparison) {
  const PathFigures& path = comparison.path;
  line(text, "\n{}", path_title(comparison));
  line(text, "  {:26}{:11.5g} m", "path of the estimate", path.estimate_m);
  line(text, "  {:26}{:11.5g} m", "path of the reference", path.reference_m);
  line(text, "  {:26}{:11.5g} m", "closing error", path.end_error_m);
  if (path.end_error_percent) {
    line(text, "  {:26}{:11.5g} %", "", *path.end_error_percent);
  }
  line(text, "  {:26}{:11.5g} deg", "", path.end_rotation_deg);
}

void add_consistency(Text& text, const Consistency& score) {
  line(text, "\n{}", title(score));
  line(text, "  {:26}{:11.5g}", "mean map entropy", score.mme);
  line(text, "  {:26}{:11.5g} m", "mean plane deviation", score.mpv_m);
  if (!score.point_to_plane) return;
  line(text, "  {:26}{:11.5g} m mean, {:.5g} m median, {:.5g} m 90 %, {} queries", "point to plane",
       score.point_to_plane->mean_m, score.point_to_plane->median_m, score.point_to_plane->p90_m,
       score.point_to_plane->queries);
}

void add_comparison(Text& text, const Comparison& comparison) {
  const std::string alignment =
      describe(comparison.alignment, comparison.association.matches.size());
  line(text, "reference    {}", poses_text(comparison.reference));
  add_reading(text, comparison.reference);
  line(text, "association  {}", describe(comparison.association));
  line(text, "alignment    {}", alignment);
  for (const std::string& warning : comparison.warnings) line(text, "warning      {}", warning);
  add_ape(text, comparison.ape, alignment);
  add_ape(text, comparison.ape_at_origin, "aligned at the first pose");
  add_split(text, comparison);
  add_rpe(text, comparison, alignment);
  if (comparison.kitti) add_kitti(text, *comparison.kitti);
  add_sub_trajectories(text, comparison);
  add_path(text, comparison);
  if (comparison.undefined.empty()) return;
  line(text, "\nnot defined");
  for (const Undefined& item : comparison.undefined) {
    line(text, "  {}: {}", item.metric, item.reason);
  }
}

}  // namespace

std::string to_table(const Evaluation& evaluation) {
  Text text;
  line(text, "estimate     {}", poses_text(evaluation.estimate));
  add_reading(text, evaluation.estimate);
  if (evaluation.comparison) add_comparison(text, *evaluation.comparison);
  if (evaluation.consistency) add_consistency(text, *evaluation.consistency);
  return fmt::to_string(text);
}

}  // namespace traverse::evaluation
