#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "traverse/geometry/pose3.hpp"

namespace traverse::dataset {

/// Coordinate frames that are fixed to each other, as transforms of a bag tell: each has one
/// parent.
class FrameTree {
 public:
  /// Of a transform that is told twice the later one holds if it is static; one that is told as
  /// moving and changes is no link at all. \returns whether it tells something new
  bool add_static(const std::string& parent, const std::string& child,
                  const geometry::Pose3& T_parent_child);
  bool add_moving(const std::string& parent, const std::string& child,
                  const geometry::Pose3& T_parent_child);

  bool has(const std::string& frame) const;
  /// T_target_source, if a chain of links leads from one to the other. Equal names need no link.
  std::optional<geometry::Pose3> find(const std::string& target, const std::string& source) const;
  /// Whether a link on the way between them was told by a moving transform.
  bool is_by_moving(const std::string& target, const std::string& source) const;

  /// A frame's name as TF2 has it: without the leading '/'.
  static std::string name_of(std::string_view frame);

 private:
  struct Link {
    std::string parent;
    geometry::Pose3 T_parent_child;
    bool is_static = true;
    bool has_moved = false;
  };
  /// The frame and those that it hangs on, with their T_above_frame.
  std::vector<std::pair<std::string, geometry::Pose3>> above(const std::string& frame) const;

  std::map<std::string, Link> links_;  ///< by child
};

}  // namespace traverse::dataset
