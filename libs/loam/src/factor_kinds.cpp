#include "traverse/loam/factor_kinds.hpp"

#include <string>
#include <utility>

#include "point_factor_list.hpp"

namespace traverse::loam {

namespace {

using optimization::Derivative;
using optimization::FactorKind;
using optimization::FactorSample;
using optimization::Perturbation;
using optimization::RandomStates;

std::string name_of(LineForm form, Sweep sweep) {
  const std::string name = form == LineForm::kVector ? "line vector" : "line scalar";
  return sweep == Sweep::kSwept ? "swept " + name : name;
}

std::string name_of(PlaneForm form, Sweep sweep) {
  const std::string name = form == PlaneForm::kSigned ? "plane signed" : "plane absolute";
  return sweep == Sweep::kSwept ? "swept " + name : name;
}

/// A line or a plane half a metre to five metres from q: away from zero residual.
template <typename Residual>
Residual residual_away_from(const Eigen::Vector3d& q, RandomStates& random) {
  const double distance = random.uniform(0.5, 5);
  if constexpr (requires(Residual residual) { residual.line; }) {
    const Eigen::Vector3d direction = random.unit_vector();
    const Eigen::Vector3d across = direction.cross(random.unit_vector()).normalized();
    return {Line{q + distance * across + random.uniform(-5, 5) * direction, direction}};
  } else {
    const Eigen::Vector3d normal = random.unit_vector();
    const double side = random.uniform(-1, 1) < 0 ? -1 : 1;
    return {Plane{normal, side * distance - normal.dot(q)}};
  }
}

/// A cost function that keeps the list alive in which it stands.
template <typename Residual>
std::shared_ptr<const ceres::CostFunction> made(const PointMotion& motion, const Residual& residual,
                                                Derivative derivative) {
  auto list = std::make_shared<PointFactorList<Residual>>();
  return {list, list->add(motion, residual, derivative)};
}

template <typename Residual>
FactorSample sample(Sweep sweep, RandomStates& random, Perturbation perturbation) {
  const bool swept = sweep == Sweep::kSwept;
  // Up to short of a half turn, where the short way round a swept rotation changes.
  const Eigen::Vector4d q = random.quaternion(swept ? 2.5 : 3);
  const Eigen::Vector3d t = random.vector(10);
  const PointMotion motion(random.vector(20), swept ? random.uniform(0.05, 1) : 1, perturbation);
  const auto moved = motion.at(Eigen::Quaterniond(q), t);
  const auto residual = residual_away_from<Residual>(moved.q_map, random);
  return {made(motion, residual, Derivative::kAnalytic),
          made(motion, residual, Derivative::kAutomatic),
          {q, t}};
}

template <typename Residual>
FactorKind kind(std::string name, std::string formula, Sweep sweep) {
  formula += sweep == Sweep::kSwept ? ", q = Exp(s Log R) p + s t" : ", q = R p + t";
  return {std::move(name),
          std::move(formula),
          {{"rotation", 4, true}, {"translation", 3, false}},
          {Perturbation::kRight, Perturbation::kLeft},
          [sweep](RandomStates& random, Perturbation perturbation) {
            return sample<Residual>(sweep, random, perturbation);
          }};
}

}  // namespace

std::vector<FactorKind> factor_kinds() {
  std::vector<FactorKind> kinds;
  for (const Sweep sweep : {Sweep::kDeskewed, Sweep::kSwept}) {
    kinds.push_back(
        kind<LineVectorResidual>(name_of(LineForm::kVector, sweep), "r = u × (q − c)", sweep));
    kinds.push_back(kind<LineDistanceResidual>(name_of(LineForm::kDistance, sweep),
                                               "r = |u × (q − c)|", sweep));
    kinds.push_back(
        kind<PlaneResidual>(name_of(PlaneForm::kSigned, sweep), "r = n · q + d", sweep));
    kinds.push_back(kind<PlaneDistanceResidual>(name_of(PlaneForm::kAbsolute, sweep),
                                                "r = |n · q + d|", sweep));
  }
  return kinds;
}

std::vector<optimization::FactorUse> factors_of(const SolverOptions& options, Sweep sweep) {
  return {{name_of(options.line_form, sweep), options.perturbation},
          {name_of(options.plane_form, sweep), options.perturbation}};
}

}  // namespace traverse::loam
