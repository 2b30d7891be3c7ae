#include <algorithm>
#include <limits>
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
              {"points", "count", "horizontal rmse [cm]", "95 % [cm]", "vertical rmse [cm]",
               "95 % [cm] (vertical)", "3-D rmse [cm]", "survey, horizontal [cm]",
               "survey, vertical [cm]", "weighted, horizontal [cm]", "weighted, vertical [cm]",
               "residual/sigma, horizontal", "residual/sigma, vertical"});
  const double none = std::numeric_limits<double>::quiet_NaN();
  const auto add = [&](const char* kind, const std::optional<CheckpointFigures>& f) {
    if (!f) return;
    table.add_row({kind, Cell::count(f->count), 100 * f->rmse_horizontal_m,
                   100 * f->p95_horizontal_m, 100 * f->rmse_vertical_m, 100 * f->p95_vertical_m,
                   100 * f->rmse_3d_m, centimetres(f->survey_horizontal_m),
                   centimetres(f->survey_vertical_m), 100 * f->weighted_horizontal_m.value_or(none),
                   100 * f->weighted_vertical_m.value_or(none),
                   f->normalised_horizontal.value_or(none), f->normalised_vertical.value_or(none)});
  };
  add("control", evaluation.control);
  add("check", evaluation.check);
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
