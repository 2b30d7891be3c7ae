#pragma once

#include <stdexcept>

#include "traverse/evaluation/poses.hpp"

namespace traverse::evaluation {

/// \throws std::invalid_argument unless there are as many of both and not empty.
inline void require_matched(const Poses& estimate, const Poses& reference) {
  if (estimate.size() != reference.size() || estimate.empty()) {
    throw std::invalid_argument("evaluation needs matched poses: two lists of one size, not empty");
  }
}

}  // namespace traverse::evaluation
