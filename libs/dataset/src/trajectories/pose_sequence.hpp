#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/files/text_file.hpp"

#include "trajectories/quaternion_order.hpp"

namespace traverse::dataset {

/// \throws files::InputError
double finite_number(const files::LineReader& reader, std::string_view word);

/// Hands the poses of a file with quaternions on; looks at their lengths, at the order of their
/// columns and at that of the stamps.
class PosesInOrder {
 public:
  PosesInOrder(const PoseTaker& take, bool is_w_first) : take_(take), is_w_first_(is_w_first) {}

  /// \param columns of the quaternion, as they stand in the file
  /// \throws files::InputError about the reader's line
  void add(const files::LineReader& reader, const std::optional<geometry::Stamp>& stamp,
           const Eigen::Vector3d& t, const Eigen::Vector4d& columns);

  std::vector<std::string> notes() const;

 private:
  void require_length(const files::LineReader& reader, double length);

  const PoseTaker& take_;
  bool is_w_first_;
  std::optional<geometry::Stamp> last_;
  QuaternionOrder order_;
  std::size_t normalised_ = 0;
  double shortest_ = 1;
  double longest_ = 1;
};

}  // namespace traverse::dataset
