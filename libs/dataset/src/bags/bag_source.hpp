#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "traverse/dataset/open_recording.hpp"

namespace traverse::dataset {

/// Whether the path is what its row in recording_formats.cpp says.
bool is_ros1_bag_file(const std::filesystem::path& file);
bool is_folder_of_ros1_bags(const std::filesystem::path& folder);
bool is_ros2_bag_folder(const std::filesystem::path& folder);
bool is_ros2_database(const std::filesystem::path& file);
bool is_mcap_file(const std::filesystem::path& file);

/// A recording of ROS messages: one topic of each kind of sensor, chosen by what the bag holds or
/// by what is stated (lidar.topic, imu.topic, gnss.topic, wheels.topic), mounted as its transforms
/// say. Facts about X.bag stand in X.traverse.yaml, about a folder in traverse.yaml there. \param
/// format the name of it, see recording_formats.hpp \throws files::InputError if no message of a
/// topic can be used, unless `options` ask only for what there is
std::unique_ptr<Source> open_bag(const std::filesystem::path& path, const OpenOptions& options,
                                 std::string_view format);

}  // namespace traverse::dataset
