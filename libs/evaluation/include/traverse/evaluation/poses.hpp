#pragma once

#include <concepts>
#include <cstddef>
#include <functional>
#include <span>
#include <utility>

#include "traverse/geometry/pose3.hpp"

namespace traverse::evaluation {

/// Poses T_map_body to be read by index, wherever they are: in memory, on disk, or made of others
/// when they are asked for. A view: what it was made of must outlive it.
class Poses {
 public:
  Poses() = default;
  /// Of a vector, an array or a span.
  template <typename Range>
  requires std::convertible_to<const Range&, std::span<const geometry::Pose3>> Poses(
      const Range& poses)
      : Poses(std::span<const geometry::Pose3>(poses).size(),
              [kept = std::span<const geometry::Pose3>(poses)](std::size_t i) { return kept[i]; }) {
  }
  /// \param pose tells each pose from 0 to `size` - 1, the same whenever it is asked
  Poses(std::size_t size, std::function<geometry::Pose3(std::size_t)> pose)
      : size_(size), pose_(std::move(pose)) {}

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  geometry::Pose3 operator[](std::size_t i) const { return pose_(i); }
  geometry::Pose3 front() const { return pose_(0); }
  geometry::Pose3 back() const { return pose_(size_ - 1); }

 private:
  std::size_t size_ = 0;
  std::function<geometry::Pose3(std::size_t)> pose_;
};

}  // namespace traverse::evaluation
