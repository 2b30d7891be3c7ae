#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/pipeline/frame_table.hpp"
#include "traverse/pipeline/run_folder.hpp"

namespace traverse::pipeline {

enum class IsWhole { kNo, kYes };

/// That the cloud has the field, with values in [least, most]. \throws files::InputError
void require_values(const dataset::PointCloud& cloud, const std::filesystem::path& file,
                    const std::string& field, double least, double most, IsWhole is_whole);
/// The same of a field that may be absent.
void require_values_if_there(const dataset::PointCloud& cloud, const std::filesystem::path& file,
                             const std::string& field, double least, double most, IsWhole is_whole);

/// That the cloud has the points that run.json counts. \throws files::InputError
void require_size(const dataset::PointCloud& cloud, const std::filesystem::path& file,
                  std::size_t points);

/// That worst_frames.ply is of frames of frames.csv. \throws files::InputError
void require_worst_frames(const dataset::PointCloud& cloud, const RunFolder& folder,
                          const FrameTable& frames);

}  // namespace traverse::pipeline
