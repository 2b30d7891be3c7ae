#include "pose_factors.hpp"

#include "point_factor_list.hpp"

namespace traverse::loam {

struct PoseFactors::Lists {
  PointFactorList<LineVectorResidual> line_vectors;
  PointFactorList<LineDistanceResidual> line_distances;
  PointFactorList<PlaneResidual> planes;
  PointFactorList<PlaneDistanceResidual> plane_distances;
};

PoseFactors::PoseFactors(const Matches& matches, const SolverOptions& options)
    : lists_(std::make_unique<Lists>()) {
  cost_functions_.reserve(matches.size());
  const auto add = [&](auto& list, const auto& match, const auto& residual) {
    const PointMotion motion(match.p_lidar, match.fraction, options.perturbation);
    cost_functions_.push_back(list.add(motion, residual, options.derivative));
  };
  for (const LineMatch& match : matches.lines) {
    if (options.line_form == LineForm::kVector) {
      add(lists_->line_vectors, match, LineVectorResidual{match.line});
    } else {
      add(lists_->line_distances, match, LineDistanceResidual{match.line});
    }
  }
  for (const PlaneMatch& match : matches.planes) {
    if (options.plane_form == PlaneForm::kSigned) {
      add(lists_->planes, match, PlaneResidual{match.plane});
    } else {
      add(lists_->plane_distances, match, PlaneDistanceResidual{match.plane});
    }
  }
}

PoseFactors::PoseFactors(PoseFactors&&) noexcept = default;
PoseFactors& PoseFactors::operator=(PoseFactors&&) noexcept = default;
PoseFactors::~PoseFactors() = default;

}  // namespace traverse::loam
