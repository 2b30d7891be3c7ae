#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace traverse::dataset {

/// Finds out whether the four columns of a trajectory's quaternions stand in the other of the two
/// orders in use, x y z w and w x y z.
///
/// The angles between rotations do not tell: they are the same in any order. What moves along its
/// axes does: a vehicle (or the camera on it) keeps its direction of travel in its own frame while
/// it turns, which it does not where the rotations are others. Nothing is told of a path that does
/// not turn, or of a body that moves to all sides.
class QuaternionOrder {
 public:
  /// \param columns the four numbers as they stand in the file
  void add(const Eigen::Vector3d& p_map, const Eigen::Vector4d& columns);

  /// A sentence if the other order makes much more sense than the one that was taken.
  std::optional<std::string> hint(bool was_w_first) const;

 private:
  struct Kept {
    Eigen::Vector3d p_map;
    Eigen::Vector4d columns;
  };
  /// Length of the sum of all steps in the body's frame, of the sum of their lengths. A step leads
  /// from a pose to the `stride`-th after it: over longer ones noise matters less.
  double steadiness(bool is_w_first, std::size_t stride) const;

  static constexpr std::size_t kMostKept = 1024;
  std::vector<Kept> kept_;
  std::size_t every_ = 1;
  std::size_t seen_ = 0;
};

}  // namespace traverse::dataset
