#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "traverse/evaluation/trajectory_view.hpp"

namespace traverse::evaluation {

struct AssociationOptions {
  double max_time_difference_s = 0.01;  ///< poses further apart in time do not belong together
  double time_offset_s = 0;             ///< added to the stamps of the estimate
};

/// A pose of the estimate and the pose of the reference that it is compared with.
struct Match {
  std::size_t estimate = 0;      ///< index into the estimate
  std::size_t reference = 0;     ///< index into the reference
  double time_difference_s = 0;  ///< estimate (with the offset) minus reference
};

enum class AssociationMode {
  kStamp,  ///< nearest in time
  kIndex,  ///< both files have no stamps: pose i with pose i
};
inline constexpr std::array<std::pair<std::string_view, AssociationMode>, 2> kAssociationNames{
    {{"stamp", AssociationMode::kStamp}, {"index", AssociationMode::kIndex}}};
std::string_view name_of(AssociationMode mode);

struct Association {
  AssociationMode mode = AssociationMode::kStamp;
  AssociationOptions options;
  std::vector<Match> matches;  ///< in the order of the shorter trajectory

  double largest_time_difference_s() const;
};

/// Finds for each pose of the shorter trajectory (of two equally long ones: the estimate) the pose
/// of the other that is nearest in time, the first of several, and keeps it if it is near enough.
/// Not one to one: two poses may be matched with the same one. Nothing is interpolated.
///
/// Which is nearest, and what is near enough, is decided as evo does, on doubles of seconds: at
/// today's Unix time they are 0.24 microseconds apart, and that decides between two stamps that are
/// equally near, or at the limit itself. The longer trajectory is moved by the offset (the
/// reference by its opposite). Source: evo, associate_trajectories. \throws EvaluationError if a
/// trajectory is empty, only one has stamps, stamps go back, no pose finds a partner (with both
/// spans and the closest difference), or trajectories without stamps differ in size;
/// std::invalid_argument for options that are negative or not finite.
Association associate(const TrajectoryView& estimate, const TrajectoryView& reference,
                      const AssociationOptions& options);

/// The poses of `matches`, element k of both belonging together.
struct MatchedPoses {
  Poses estimate;
  Poses reference;

  std::size_t size() const { return reference.size(); }
};

/// A view of the trajectories and the matches, which must outlive it.
MatchedPoses matched_poses(const TrajectoryView& estimate, const TrajectoryView& reference,
                           std::span<const Match> matches);

}  // namespace traverse::evaluation
