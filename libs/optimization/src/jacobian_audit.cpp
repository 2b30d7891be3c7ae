#include "traverse/optimization/jacobian_audit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "traverse/optimization/shown_jacobians.hpp"

#include "factor_derivatives.hpp"

namespace traverse::optimization {

namespace {

/// The larger; NaN if either is, so that it cannot hide.
double worse(double a, double b) { return std::isnan(a) || a > b ? a : b; }

double largest_entry(const Eigen::MatrixXd& matrix) {
  double largest = 0;
  for (const double entry : matrix.reshaped()) largest = worse(std::abs(entry), largest);
  return largest;
}

void compare(const Eigen::MatrixXd& analytic, const Eigen::MatrixXd& other, std::size_t state,
             JacobianDifference& difference) {
  const double absolute = largest_entry(analytic - other);
  const double scale = worse(largest_entry(analytic), largest_entry(other));
  const double relative = absolute == 0 ? 0 : absolute / scale;
  difference.absolute = worse(absolute, difference.absolute);
  if (relative > difference.relative || std::isnan(relative)) {
    difference.relative = relative;
    difference.worst_state = state;
  }
}

/// A factor at a random state that is away from zero residual, where a norm has no derivative and
/// a wrong Jacobian of it may look right.
std::pair<FactorSample, Linearised> draw(const FactorKind& kind, Perturbation perturbation,
                                         double min_residual, RandomStates& random) {
  constexpr int kMostDraws = 10000;
  for (int i = 0; i < kMostDraws; ++i) {
    FactorSample sample = kind.make(random, perturbation);
    Linearised analytic = linearise(*sample.analytic, kind.blocks, perturbation, sample.state);
    if (!(analytic.residual.norm() < min_residual))  // nor one that is not a number
      return {std::move(sample), std::move(analytic)};
  }
  throw std::invalid_argument(kind.name + ": none of " + std::to_string(kMostDraws) +
                              " random states has a residual of " + std::to_string(min_residual) +
                              " or more");
}

FactorAudit audit(const FactorKind& kind, Perturbation perturbation, const AuditOptions& options) {
  FactorAudit result;
  result.factor = kind.name;
  result.formula = kind.formula;
  result.perturbation = perturbation;
  result.min_residual = std::numeric_limits<double>::infinity();
  for (const ParameterBlock& block : kind.blocks) result.blocks.push_back({block.name, 0, {}, {}});

  RandomStates random(options.seed);
  for (std::size_t state = 0; state < options.states; ++state) {
    const auto [sample, analytic] = draw(kind, perturbation, options.min_residual, random);
    const Linearised automatic =
        linearise(*sample.automatic, kind.blocks, perturbation, sample.state);
    const auto numeric =
        central_differences(*sample.analytic, kind.blocks, perturbation, sample.state);
    result.min_residual = std::min(result.min_residual, analytic.residual.norm());
    result.value_difference =
        worse((analytic.residual - automatic.residual).norm(), result.value_difference);
    for (std::size_t k = 0; k < kind.blocks.size(); ++k) {
      BlockAudit& block = result.blocks[k];
      block.largest_entry = worse(largest_entry(analytic.jacobians[k]), block.largest_entry);
      compare(analytic.jacobians[k], automatic.jacobians[k], state, block.automatic);
      compare(analytic.jacobians[k], numeric[k], state, block.numeric);
    }
  }

  result.passed = result.value_difference <= options.automatic_tolerance;
  for (BlockAudit& block : result.blocks) {
    block.passed = block.automatic.relative <= options.automatic_tolerance &&
                   block.numeric.relative <= options.numeric_tolerance;
    result.passed = result.passed && block.passed;
  }
  return result;
}

}  // namespace

bool JacobianAudit::passed() const {
  return std::all_of(factors.begin(), factors.end(), [](const auto& f) { return f.passed; });
}

JacobianAudit audit_jacobians(std::span<const FactorKind> kinds, const AuditOptions& options) {
  JacobianAudit result;
  result.options = options;
  for (const FactorKind& kind : kinds) {
    for (const Perturbation perturbation : kind.perturbations) {
      result.factors.push_back(audit(kind, perturbation, options));
    }
  }
  return result;
}

ShownFactor show_jacobians(const FactorKind& kind, Perturbation perturbation,
                           const AuditOptions& options) {
  RandomStates random(options.seed);
  const auto [sample, analytic] = draw(kind, perturbation, options.min_residual, random);
  const Linearised automatic =
      linearise(*sample.automatic, kind.blocks, perturbation, sample.state);
  const auto numeric =
      central_differences(*sample.analytic, kind.blocks, perturbation, sample.state);
  ShownFactor shown{kind.name, kind.formula, perturbation, analytic.residual, {}};
  for (std::size_t k = 0; k < kind.blocks.size(); ++k) {
    shown.blocks.push_back(
        {kind.blocks[k].name, analytic.jacobians[k], automatic.jacobians[k], numeric[k]});
  }
  return shown;
}

std::vector<FactorKind> selected(std::span<const FactorKind> kinds,
                                 std::span<const FactorUse> uses) {
  std::vector<FactorKind> result;
  for (const FactorUse& use : uses) {
    const auto kind = std::find_if(kinds.begin(), kinds.end(),
                                   [&](const FactorKind& k) { return k.name == use.factor; });
    if (kind == kinds.end()) {
      throw std::invalid_argument("no factor is registered as '" + use.factor + "'");
    }
    result.push_back(*kind);
    result.back().perturbations = {use.perturbation};
  }
  return result;
}

}  // namespace traverse::optimization
