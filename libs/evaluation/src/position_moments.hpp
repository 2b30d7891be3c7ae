#pragma once

#include <cstddef>
#include <string>

#include <Eigen/Core>

#include "traverse/evaluation/poses.hpp"
#include "traverse/geometry/umeyama.hpp"

namespace traverse::evaluation {

/// What matched positions have in common, and the orientations with them: first and second moments.
class PositionMoments {
 public:
  /// Of the first `used` poses.
  PositionMoments(const Poses& estimate, const Poses& reference, std::size_t used);

  /// What the positions do not tell of a rotation.
  enum class Open { kNothing, kAboutLine, kAll };
  Open open() const { return open_; }
  /// Why, for a message.
  const std::string& reason() const { return reason_; }

  /// The transform of least squares as far as the positions tell it, what is open of the rotation
  /// by the orientations, a scale that is open 1.
  geometry::Similarity alignment(bool with_scale) const;

 private:
  void find_open();
  Eigen::Matrix3d rotation() const;

  std::size_t used_ = 0;
  Eigen::Vector3d mean_x_ = Eigen::Vector3d::Zero();  ///< x: the estimate
  Eigen::Vector3d mean_y_ = Eigen::Vector3d::Zero();  ///< y: the reference
  Eigen::Matrix3d xx_ = Eigen::Matrix3d::Zero();      ///< mean of (x - mean)(x - mean)^T
  Eigen::Matrix3d yy_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d yx_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d orientations_ = Eigen::Matrix3d::Zero();  ///< mean of R_reference R_estimate^T
  Open open_ = Open::kNothing;
  std::string reason_;
  Eigen::Vector3d line_x_ = Eigen::Vector3d::UnitX();  ///< that belong together
  Eigen::Vector3d line_y_ = Eigen::Vector3d::UnitX();
};

}  // namespace traverse::evaluation
