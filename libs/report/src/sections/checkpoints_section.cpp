#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "traverse/evaluation/checkpoints.hpp"

#include "run/number_texts.hpp"
#include "sections/sections.hpp"

namespace traverse::report {

namespace {

using evaluation::CheckpointEvaluation;
using evaluation::CheckpointFigures;
using evaluation::CheckpointResidual;

constexpr std::size_t kMostPointsShown = 60;

Cell centimetres(double metres) {
  return metres > 0 ? Cell(100 * metres) : Cell(std::numeric_limits<double>::quiet_NaN());
}

Table points_table(const CheckpointEvaluation& evaluation) {
  std::vector<const CheckpointResidual*> shown;
  for (const CheckpointResidual& one : evaluation.residuals) shown.push_back(&one);
  const bool all = shown.size() <= kMostPointsShown;
  if (!all) {
    std::stable_sort(shown.begin(), shown.end(), [](const auto* a, const auto* b) {
      return a->residual_m.norm() > b->residual_m.norm();
    });
    shown.resize(kMostPointsShown);
  }
  Table table("checkpoints",
              all ? std::string("Residuals, estimate less survey")
                  : fmt::format("Residuals, estimate less survey, the {} largest of {}",
                                kMostPointsShown, evaluation.residuals.size()),
              {"point", "use", "dE [cm]", "dN [cm]", "dH [cm]", "sigma E [cm]", "sigma N [cm]",
               "sigma H [cm]"});
  for (const CheckpointResidual* one : shown) {
    const Eigen::Vector3d& d = one->residual_m;
    const Eigen::Vector3d& sigma = one->point.sigma_m;
    table.add_row({one->point.name, one->point.is_control ? "control" : "check", 100 * d.x(),
                   100 * d.y(), 100 * d.z(), centimetres(sigma.x()), centimetres(sigma.y()),
                   centimetres(sigma.z())});
  }
  return table;
}

Table checkpoint_figures_table(const CheckpointEvaluation& evaluation) {
  Table table("checkpoint_figures", "Of control and check points apart",
              {"figure", "unit", "control", "check"});
  const double none = std::numeric_limits<double>::quiet_NaN();
  const auto add = [&](const char* name, const char* unit, auto figure) {
    const auto cell = [&](const std::optional<CheckpointFigures>& f) {
      return f ? Cell(figure(*f)) : Cell(none);
    };
    table.add_row({name, unit, cell(evaluation.control), cell(evaluation.check)});
  };
  const auto add_cm = [&](const char* name, double CheckpointFigures::*metres) {
    add(name, "cm", [metres](const CheckpointFigures& f) { return 100 * (f.*metres); });
  };
  const auto add_if_told = [&](const char* name, const char* unit, double scale,
                               std::optional<double> CheckpointFigures::*value) {
    const auto is_told = [&](const std::optional<CheckpointFigures>& f) {
      return f && ((*f).*value).has_value();
    };
    if (!is_told(evaluation.control) && !is_told(evaluation.check)) return;
    add(name, unit, [=](const CheckpointFigures& f) { return scale * (f.*value).value_or(none); });
  };
  const auto count = [](const std::optional<CheckpointFigures>& f) {
    return Cell::count(f ? f->count : 0);
  };
  table.add_row({"points", "", count(evaluation.control), count(evaluation.check)});
  add_cm("horizontal, rmse", &CheckpointFigures::rmse_horizontal_m);
  add_cm("horizontal, 95 %", &CheckpointFigures::p95_horizontal_m);
  add_cm("vertical, rmse", &CheckpointFigures::rmse_vertical_m);
  add_cm("vertical, 95 %", &CheckpointFigures::p95_vertical_m);
  add_cm("in space, rmse", &CheckpointFigures::rmse_3d_m);
  add_cm("the survey itself, horizontal", &CheckpointFigures::survey_horizontal_m);
  add_cm("the survey itself, vertical", &CheckpointFigures::survey_vertical_m);
  add_if_told("horizontal, weighted by the survey's variances", "cm", 100,
              &CheckpointFigures::weighted_horizontal_m);
  add_if_told("vertical, weighted by the survey's variances", "cm", 100,
              &CheckpointFigures::weighted_vertical_m);
  add_if_told("residual over deviation, horizontal: about 1 where the survey explains it", "", 1,
              &CheckpointFigures::normalised_horizontal);
  add_if_told("residual over deviation, vertical", "", 1, &CheckpointFigures::normalised_vertical);
  return table;
}

}  // namespace

bool has_checkpoints(const RunData& run) { return run.checkpoints.has_value(); }

void add_checkpoints(const RunData& run, Model& model) {
  const CheckpointEvaluation& evaluation = *run.checkpoints;
  std::string how = "alignment " + evaluation::describe_alignment(evaluation);
  for (const std::string& note : evaluation.notes) how += "; " + note;
  model.add_text("checkpoints_how", how);
  model.add_table(checkpoint_figures_table(evaluation));
  model.add_table(points_table(evaluation));
}

}  // namespace traverse::report
