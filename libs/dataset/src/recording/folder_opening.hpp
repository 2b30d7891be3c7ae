#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "traverse/dataset/open_recording.hpp"

#include "kitti/kitti_calibration.hpp"
#include "recording/folder_source.hpp"
#include "recording/profile_choice.hpp"
#include "recording/reference_choice.hpp"
#include "recording/statements.hpp"

namespace traverse::dataset {

/// What the formats of a folder with one file a scan have in common: each of these asks the
/// statements first, then takes the format's default, and notes in the facts what it was and why.
/// The body is the lidar.

/// Path, format, name and body frame.
RecordingInfo begin_info(const std::filesystem::path& path, std::string_view format,
                         const Statements& statements, const std::string& body_frame);

/// Mounts the lidar in the origin of the body.
void mount_lidar(RecordingInfo& info, const std::string& label, const ProfileChoice& choice,
                 const Statements& statements);

void set_motion_compensation(RecordingInfo& info, const Statements& statements, bool otherwise,
                             const std::string& why);

/// The scan with its coordinates in metres, of which they count `unit_m`.
sensors::LidarScan in_metres(sensors::LidarScan scan, double unit_m);

/// The camera from the calibration file that is stated, or else from `otherwise` if it is there.
void set_camera(RecordingInfo& info, const Statements& statements,
                const std::filesystem::path& otherwise);

/// The reference that is stated, or else `found`, which is passed over when it cannot be used.
std::optional<Reference> choose_reference(RecordingInfo& info, const Statements& statements,
                                          const std::optional<ReferenceFile>& found,
                                          const PoseStamps& stamps);

/// \param format the name of it, see recording_formats.hpp
/// \throws files::InputError if the recording cannot be used at all.
std::unique_ptr<Source> open_kitti_odometry(const std::filesystem::path& folder,
                                            const OpenOptions& options, std::string_view format);
std::unique_ptr<Source> open_kitti_raw(const std::filesystem::path& folder,
                                       const OpenOptions& options, std::string_view format);
std::unique_ptr<Source> open_point_cloud_folder(const std::filesystem::path& folder,
                                                const OpenOptions& options,
                                                std::string_view format);

}  // namespace traverse::dataset
