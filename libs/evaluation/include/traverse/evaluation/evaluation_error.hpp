#pragma once

#include <stdexcept>

namespace traverse::evaluation {

/// The trajectories do not allow what was asked: no pose of one belongs to a pose of the other, no
/// pair of poses is far enough apart, the alignment is not determined. The message says what was
/// found instead.
class EvaluationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace traverse::evaluation
