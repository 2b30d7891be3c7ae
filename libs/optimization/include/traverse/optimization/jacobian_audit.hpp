#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "traverse/optimization/factor_kind.hpp"

namespace traverse::files {
class JsonValue;
}

namespace traverse::optimization {

struct AuditOptions {
  std::size_t states = 200;           ///< random instances of each factor and perturbation
  std::uint32_t seed = 1;             ///< of them; equal seeds give equal figures
  double min_residual = 0.1;          ///< |r| of a state that is used; in the residual's units
  double automatic_tolerance = 1e-9;  ///< largest relative difference to automatic derivatives
  double numeric_tolerance = 1e-7;    ///< to differences, which are exact to about 1e-10
};

/// The largest difference of a block's Jacobians over all states.
struct JacobianDifference {
  double absolute = 0;  ///< of an entry: units of the residual a unit of the tangent (rad, m, ...)
  double relative = 0;  ///< absolute, over the largest entry of the block in the same state
  std::size_t worst_state = 0;  ///< number of the state of the largest relative one, from 0
};

/// The analytic Jacobian of one parameter block against two others, in the tangent space.
struct BlockAudit {
  std::string block;
  double largest_entry = 0;      ///< of the analytic Jacobian over all states
  JacobianDifference automatic;  ///< to dual numbers
  JacobianDifference numeric;    ///< to central differences of fourth order
  bool passed = false;           ///< both relative differences are within their tolerance
};

/// One factor with one perturbation.
struct FactorAudit {
  std::string factor;
  std::string formula;
  Perturbation perturbation = Perturbation::kRight;
  double min_residual = 0;      ///< |r| over the states: how far from zero the check stayed
  double value_difference = 0;  ///< largest |r_analytic - r_automatic|
  std::vector<BlockAudit> blocks;
  bool passed = false;  ///< all blocks, and both forms are one residual to automatic_tolerance
};

struct JacobianAudit {
  AuditOptions options;
  std::vector<FactorAudit> factors;

  bool passed() const;
};

/// Checks the analytic Jacobians of every kind for each of its perturbations: at random states
/// against automatic derivatives, and against central differences of its own value along
/// RotationManifold's Plus. A factor that cannot be evaluated, or gives NaN, fails.
/// \throws std::invalid_argument for a factor whose residual is never options.min_residual.
JacobianAudit audit_jacobians(std::span<const FactorKind> kinds, const AuditOptions& options);

/// The kinds that `uses` name, each with the perturbations named. \throws std::invalid_argument for
/// a name that no kind has.
std::vector<FactorKind> selected(std::span<const FactorKind> kinds,
                                 std::span<const FactorUse> uses);

/// The audit as JSON: {"passed", "states", "seed", "min_residual", "tolerance": {"automatic",
/// "numeric"}, "factors": [{"factor", "formula", "perturbation", "passed", "min_residual",
/// "value_difference", "blocks": [{"block", "passed", "largest_entry", "automatic": D,
/// "numeric": D}]}]} with D = {"absolute", "relative", "worst_state"}; null for what is not finite.
std::string to_json(const JacobianAudit& audit);

/// Reads what to_json() wrote. \throws files::InputError naming the file and the key.
JacobianAudit audit_from_json(const files::JsonValue& json);

}  // namespace traverse::optimization
