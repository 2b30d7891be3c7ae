#pragma once

#include <Eigen/Core>

#include "traverse/render/rect.hpp"

namespace traverse::render {

/// How a scene is seen. The eye's frame: x to the right, y up, z towards the viewer.
struct Camera {
  Eigen::Matrix4d T_eye_scene = Eigen::Matrix4d::Identity();
  bool perspective = false;
  /// What the viewport shows to each side of its centre: metres, or in perspective the tangent of
  /// half the field of view.
  double half_width = 1;
  double half_height = 1;
  double near = -1;  ///< least distance along the view that is drawn, metres
  double far = 1;    ///< largest

  /// Looks straight down, x of the scene to the right, y up; true to scale.
  static Camera from_above(const Eigen::Vector2d& centre, double half_width, double half_height,
                           double lowest_z, double highest_z);

  /// Stands at `eye` and looks at `target`, z of the scene upwards. Units: metres, radians.
  static Camera looking_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target,
                           double vertical_field_of_view, double aspect, double near, double far);

  /// Clip coordinates (of OpenGL, but y down) from the scene's homogeneous coordinates.
  Eigen::Matrix4d clip_from_scene() const;

  /// Distance along the view of a point, metres.
  double depth(const Eigen::Vector3d& p_scene) const;

  /// Where a point of the scene appears; meaningless behind the eye (depth() <= 0).
  Point project(const Eigen::Vector3d& p_scene, const Rect& viewport) const;

  bool operator==(const Camera&) const = default;
};

}  // namespace traverse::render
