#pragma once

#include <cstddef>
#include <optional>

#include "traverse/geometry/pose3.hpp"

namespace traverse::app {

/// How far an estimated path has come, to tell whether other streams can be held against it.
class ProbedPath {
 public:
  void add(const geometry::Pose3& T_map_body);

  /// \param has_others there are streams beside the lidar's; without them a few seconds are enough
  bool is_enough(bool has_others) const;

 private:
  std::size_t frames_ = 0;
  double length_m_ = 0;
  double turned_ = 0;  ///< rad in all
  std::optional<geometry::Pose3> last_;
};

}  // namespace traverse::app
