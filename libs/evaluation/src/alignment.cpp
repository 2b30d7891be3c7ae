#include "traverse/evaluation/alignment.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "traverse/evaluation/evaluation_error.hpp"
#include "traverse/geometry/umeyama.hpp"

#include "names.hpp"
#include "require_matched.hpp"

namespace traverse::evaluation {

using geometry::Pose3;

namespace {

std::vector<Eigen::Vector3d> positions_of(std::span<const Pose3> poses) {
  std::vector<Eigen::Vector3d> positions;
  positions.reserve(poses.size());
  for (const Pose3& pose : poses) positions.push_back(pose.translation);
  return positions;
}

Alignment align_by_positions(std::span<const Pose3> estimate, std::span<const Pose3> reference,
                             AlignmentMode mode) {
  Alignment alignment{mode, {}, 1, estimate.size()};
  try {
    const auto similarity = geometry::umeyama(positions_of(estimate), positions_of(reference),
                                              mode != AlignmentMode::kSe3);
    alignment.scale = similarity.scale;
    if (mode != AlignmentMode::kScale) alignment.T_reference_estimate = similarity.T_y_x;
  } catch (const geometry::DegenerateAlignment&) {
    throw EvaluationError(
        fmt::format("the {} alignment is not determined: the {} positions it is found from lie on "
                    "one point or one line; alignment at the origin or none is possible",
                    name_of(mode), estimate.size()));
  }
  return alignment;
}

}  // namespace

std::string_view name_of(AlignmentMode mode) { return name_in(kAlignmentNames, mode); }

Pose3 Alignment::operator()(const Pose3& T_estimate_body) const {
  return T_reference_estimate *
         Pose3{T_estimate_body.rotation, scale * T_estimate_body.translation};
}

Alignment align(std::span<const Pose3> estimate, std::span<const Pose3> reference,
                const AlignmentOptions& options) {
  require_matched(estimate, reference);
  if (options.first == std::size_t{0}) {
    throw std::invalid_argument("an alignment needs at least one pose");
  }
  const std::size_t used = std::min(options.first.value_or(estimate.size()), estimate.size());
  switch (options.mode) {
    case AlignmentMode::kNone:
      break;
    case AlignmentMode::kOrigin:
      return {options.mode, reference.front() * estimate.front().inverse(), 1, 1};
    case AlignmentMode::kSe3:
    case AlignmentMode::kSim3:
    case AlignmentMode::kScale:
      return align_by_positions(estimate.first(used), reference.first(used), options.mode);
  }
  return {};
}

std::vector<Pose3> aligned(std::span<const Pose3> estimate, const Alignment& alignment) {
  std::vector<Pose3> poses;
  poses.reserve(estimate.size());
  for (const Pose3& pose : estimate) poses.push_back(alignment(pose));
  return poses;
}

}  // namespace traverse::evaluation
