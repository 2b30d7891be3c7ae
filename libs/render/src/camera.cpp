#include "traverse/render/camera.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace traverse::render {

Camera Camera::from_above(const Eigen::Vector2d& centre, double half_width, double half_height,
                          double lowest_z, double highest_z) {
  Camera camera;
  camera.T_eye_scene.topRightCorner<3, 1>() = Eigen::Vector3d(-centre.x(), -centre.y(), -highest_z);
  camera.half_width = half_width;
  camera.half_height = half_height;
  // A little room at both ends, so that the lowest and the highest point are not cut off.
  const double room = 1e-3 * (highest_z - lowest_z) + 1e-3;
  camera.near = -room;
  camera.far = highest_z - lowest_z + room;
  return camera;
}

Camera Camera::looking_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target,
                          double vertical_field_of_view, double aspect, double near, double far) {
  const Eigen::Vector3d backward = (eye - target).normalized();
  const Eigen::Vector3d right = Eigen::Vector3d::UnitZ().cross(backward).normalized();
  Camera camera;
  camera.T_eye_scene.block<1, 3>(0, 0) = right.transpose();
  camera.T_eye_scene.block<1, 3>(1, 0) = backward.cross(right).transpose();
  camera.T_eye_scene.block<1, 3>(2, 0) = backward.transpose();
  camera.T_eye_scene.topRightCorner<3, 1>() = -camera.T_eye_scene.topLeftCorner<3, 3>() * eye;
  camera.perspective = true;
  camera.half_height = std::tan(vertical_field_of_view / 2);
  camera.half_width = camera.half_height * aspect;
  camera.near = near;
  camera.far = far;
  return camera;
}

Eigen::Matrix4d Camera::clip_from_scene() const {
  Eigen::Matrix4d clip_from_eye = Eigen::Matrix4d::Zero();
  clip_from_eye(0, 0) = 1 / half_width;
  clip_from_eye(1, 1) = -1 / half_height;  // y down, as in pictures
  if (perspective) {
    clip_from_eye(2, 2) = -(far + near) / (far - near);
    clip_from_eye(2, 3) = -2 * far * near / (far - near);
    clip_from_eye(3, 2) = -1;
  } else {
    clip_from_eye(2, 2) = -2 / (far - near);
    clip_from_eye(2, 3) = -(far + near) / (far - near);
    clip_from_eye(3, 3) = 1;
  }
  return clip_from_eye * T_eye_scene;
}

double Camera::depth(const Eigen::Vector3d& p_scene) const {
  return -T_eye_scene.row(2).dot(p_scene.homogeneous());
}

Point Camera::project(const Eigen::Vector3d& p_scene, const Rect& viewport) const {
  const Eigen::Vector4d clip = clip_from_scene() * p_scene.homogeneous();
  return {viewport.left + (clip.x() / clip.w() + 1) / 2 * viewport.width(),
          viewport.top + (clip.y() / clip.w() + 1) / 2 * viewport.height()};
}

}  // namespace traverse::render
