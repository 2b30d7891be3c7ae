#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "traverse/evaluation/checkpoints.hpp"

namespace traverse::evaluation {

namespace {

using CheckpointJson = nlohmann::ordered_json;

CheckpointJson as_three(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

CheckpointJson or_null(const std::optional<double>& value) {
  return value ? CheckpointJson(*value) : CheckpointJson();
}

CheckpointJson figures_json(const std::optional<CheckpointFigures>& figures) {
  if (!figures) return nullptr;
  return {{"count", figures->count},
          {"rmse_m", as_three(figures->rmse_m)},
          {"rmse_horizontal_m", figures->rmse_horizontal_m},
          {"rmse_vertical_m", figures->rmse_vertical_m},
          {"rmse_3d_m", figures->rmse_3d_m},
          {"p95_horizontal_m", figures->p95_horizontal_m},
          {"p95_vertical_m", figures->p95_vertical_m},
          {"survey_horizontal_m", figures->survey_horizontal_m},
          {"survey_vertical_m", figures->survey_vertical_m},
          {"normalised_horizontal", or_null(figures->normalised_horizontal)},
          {"normalised_vertical", or_null(figures->normalised_vertical)},
          {"weighted_horizontal_m", or_null(figures->weighted_horizontal_m)},
          {"weighted_vertical_m", or_null(figures->weighted_vertical_m)}};
}

std::string figures_text(const char* kind, const std::optional<CheckpointFigures>& figures) {
  if (!figures) return "";
  std::string text = fmt::format(
      "{:<22}{} points: horizontal rmse {:.4f} m, 95 % {:.4f} m; vertical rmse {:.4f} m, 95 % "
      "{:.4f} m; 3-D rmse {:.4f} m; the survey itself {:.4f} m and {:.4f} m\n",
      kind, figures->count, figures->rmse_horizontal_m, figures->p95_horizontal_m,
      figures->rmse_vertical_m, figures->p95_vertical_m, figures->rmse_3d_m,
      figures->survey_horizontal_m, figures->survey_vertical_m);
  if (figures->weighted_horizontal_m) {
    text += fmt::format(
        "{:<22}weighted by the reference's own variances: horizontal {:.4f} m, vertical {:.4f} m; "
        "residuals over its deviations: {:.2f} and {:.2f} (about 1 where it explains them)\n",
        "", *figures->weighted_horizontal_m, *figures->weighted_vertical_m,
        *figures->normalised_horizontal, *figures->normalised_vertical);
  }
  return text;
}

}  // namespace

std::string describe_alignment(const CheckpointEvaluation& evaluation) {
  if (evaluation.alignment == AlignmentMode::kNone) return "none: the estimate as it is";
  return fmt::format("{}, by {} {}{}", name_of(evaluation.alignment), evaluation.aligned_by,
                     evaluation.is_by_all ? "points, all there are, so that nothing checks them"
                                          : "control points",
                     evaluation.alignment == AlignmentMode::kSim3
                         ? fmt::format("; scale {:.9f}", evaluation.enh_map.scale)
                         : "");
}

std::string to_table(const CheckpointEvaluation& evaluation) {
  std::string text =
      fmt::format("checkpoints           alignment {}\n", describe_alignment(evaluation));
  text += fmt::format("  {:<16}{:>8}{:>12}{:>12}{:>12}{:>14}{:>14}\n", "point", "use", "dE [m]",
                      "dN [m]", "dH [m]", "sigma EN [m]", "sigma H [m]");
  // Of a prism that is followed, or a receiver's fixes, the largest alone.
  constexpr std::size_t kMostShown = 40;
  std::vector<const CheckpointResidual*> shown;
  for (const CheckpointResidual& one : evaluation.residuals) shown.push_back(&one);
  if (shown.size() > kMostShown) {
    std::stable_sort(shown.begin(), shown.end(), [](const auto* a, const auto* b) {
      return a->residual_m.norm() > b->residual_m.norm();
    });
    shown.resize(kMostShown);
  }
  for (const CheckpointResidual* each : shown) {
    const CheckpointResidual& one = *each;
    const Eigen::Vector3d& d = one.residual_m;
    const Eigen::Vector3d& sigma = one.point.sigma_m;
    const auto told = [](double value) {
      return value > 0 ? fmt::format("{:.4f}", value) : std::string("-");
    };
    text += fmt::format("  {:<16}{:>8}{:>12.4f}{:>12.4f}{:>12.4f}{:>14}{:>14}\n", one.point.name,
                        one.point.is_control ? "control" : "check", d.x(), d.y(), d.z(),
                        told(sigma.head<2>().norm()), told(sigma.z()));
  }
  if (shown.size() < evaluation.residuals.size()) {
    text += fmt::format("  the {} largest of {}\n", shown.size(), evaluation.residuals.size());
  }
  text += figures_text("control", evaluation.control);
  text += figures_text("check", evaluation.check);
  for (const std::string& note : evaluation.notes) text += fmt::format("note: {}\n", note);
  return text;
}

std::string to_json(const CheckpointEvaluation& evaluation) {
  const geometry::Similarity& S = evaluation.enh_map;
  CheckpointJson residuals = CheckpointJson::array();
  for (const CheckpointResidual& one : evaluation.residuals) {
    residuals.push_back({{"name", one.point.name},
                         {"use", one.point.is_control ? "control" : "check"},
                         {"surveyed_m", as_three(one.point.p_enh)},
                         {"sigma_m", as_three(one.point.sigma_m)},
                         {"estimate_m", as_three(one.estimate_enh)},
                         {"residual_m", as_three(one.residual_m)}});
  }
  CheckpointJson rotation = CheckpointJson::array();
  for (Eigen::Index row = 0; row < 3; ++row) {
    rotation.push_back(as_three(S.T_y_x.rotation.row(row).transpose()));
  }
  const CheckpointJson json{{"alignment",
                             {{"mode", name_of(evaluation.alignment)},
                              {"points", evaluation.aligned_by},
                              {"by_all", evaluation.is_by_all},
                              {"scale", S.scale},
                              {"rotation", std::move(rotation)},
                              {"translation_m", as_three(S.T_y_x.translation)}}},
                            {"axes", {"east", "north", "height"}},
                            {"residuals", std::move(residuals)},
                            {"control", figures_json(evaluation.control)},
                            {"check", figures_json(evaluation.check)},
                            {"notes", evaluation.notes}};
  return json.dump(1, ' ', false, CheckpointJson::error_handler_t::replace) + "\n";
}

}  // namespace traverse::evaluation
