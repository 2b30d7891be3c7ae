#include "traverse/evaluation/alignment.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "traverse/geometry/umeyama.hpp"

#include "names.hpp"
#include "position_moments.hpp"
#include "require_matched.hpp"

namespace traverse::evaluation {

using geometry::Pose3;

namespace {

Undetermined undetermined_of(PositionMoments::Open open, AlignmentMode mode) {
  switch (open) {
    case PositionMoments::Open::kNothing:
      return Undetermined::kNothing;
    case PositionMoments::Open::kAboutLine:
      return mode == AlignmentMode::kScale ? Undetermined::kNothing
                                           : Undetermined::kRotationAboutLine;
    case PositionMoments::Open::kAll:
      if (mode == AlignmentMode::kScale) return Undetermined::kScale;
      return mode == AlignmentMode::kSim3 ? Undetermined::kRotationAndScale
                                          : Undetermined::kRotation;
  }
  return Undetermined::kNothing;
}

/// By the very sums of evo where they give something, so that figures are the same.
geometry::Similarity fit(const Poses& estimate, const Poses& reference, std::size_t used,
                         const PositionMoments& moments, bool with_scale) {
  if (moments.open() == PositionMoments::Open::kAll) return moments.alignment(with_scale);
  try {
    return geometry::umeyama(
        used, [&](std::size_t i) { return estimate[i].translation; },
        [&](std::size_t i) { return reference[i].translation; }, with_scale);
  } catch (const geometry::DegenerateAlignment&) {
    return moments.alignment(with_scale);
  }
}

/// From the first `used` poses.
Alignment align_by_positions(const Poses& estimate, const Poses& reference, std::size_t used,
                             AlignmentMode mode) {
  const PositionMoments moments(estimate, reference, used);
  Alignment alignment{mode, {}, 1, used};
  const auto similarity = fit(estimate, reference, used, moments, mode != AlignmentMode::kSe3);
  alignment.scale = similarity.scale;
  if (mode != AlignmentMode::kScale) alignment.T_reference_estimate = similarity.T_y_x;
  alignment.undetermined = undetermined_of(moments.open(), mode);
  if (alignment.undetermined != Undetermined::kNothing) alignment.reason = moments.reason();
  return alignment;
}

}  // namespace

std::string_view name_of(Undetermined undetermined) {
  return name_in(kUndeterminedNames, undetermined);
}

std::string_view name_of(AlignmentMode mode) { return name_in(kAlignmentNames, mode); }

Pose3 Alignment::operator()(const Pose3& T_estimate_body) const {
  return T_reference_estimate *
         Pose3{T_estimate_body.rotation, scale * T_estimate_body.translation};
}

Alignment align(const Poses& estimate, const Poses& reference, const AlignmentOptions& options) {
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
      return align_by_positions(estimate, reference, used, options.mode);
  }
  return {};
}

Poses aligned(Poses estimate, const Alignment& alignment) {
  const std::size_t size = estimate.size();
  return {size, [estimate = std::move(estimate), alignment](std::size_t i) {
            return alignment(estimate[i]);
          }};
}

std::vector<Pose3> to_vector(const Poses& poses) {
  std::vector<Pose3> kept;
  kept.reserve(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) kept.push_back(poses[i]);
  return kept;
}

}  // namespace traverse::evaluation
