#pragma once

#include <span>
#include <stdexcept>

#include "traverse/geometry/pose3.hpp"

namespace traverse::evaluation {

/// \throws std::invalid_argument unless the spans are of one size and not empty.
inline void require_matched(std::span<const geometry::Pose3> estimate,
                            std::span<const geometry::Pose3> reference) {
  if (estimate.size() != reference.size() || estimate.empty()) {
    throw std::invalid_argument("evaluation needs matched poses: two lists of one size, not empty");
  }
}

}  // namespace traverse::evaluation
