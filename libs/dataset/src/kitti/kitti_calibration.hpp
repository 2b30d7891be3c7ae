#pragma once

#include <filesystem>
#include <string>

#include "traverse/geometry/pose3.hpp"

namespace traverse::dataset {

/// Where camera 0 (rectified) is, from a calib.txt.
struct CameraCalibration {
  geometry::Pose3 T_camera_lidar;
  std::string how;  ///< "Tr" | "R0_rect Tr_velo_to_cam"
};

/// Reads calib.txt of the odometry benchmark (Tr) or of the tracking benchmark (Tr_velo_to_cam or
/// Tr_velo_cam, with R0_rect or R_rect if there: rectified camera 0 = R0_rect Tr_velo_to_cam). The
/// rotation is made orthonormal: files give seven digits.
/// \throws files::InputError naming the key that is missing or has the wrong number of values.
CameraCalibration read_camera_calibration(const std::filesystem::path& file);

/// Reads R and T of a calibration file of a KITTI raw drive (calib_imu_to_velo.txt).
/// \throws files::InputError
geometry::Pose3 read_raw_calibration(const std::filesystem::path& file);

/// Camera 0 (rectified) of a KITTI raw drive: R_rect_00 of calib_cam_to_cam.txt times
/// calib_velo_to_cam.txt. \throws files::InputError
geometry::Pose3 read_raw_camera_calibration(const std::filesystem::path& velo_to_cam,
                                            const std::filesystem::path& cam_to_cam);

}  // namespace traverse::dataset
