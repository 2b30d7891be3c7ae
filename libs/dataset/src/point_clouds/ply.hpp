#pragma once

#include "traverse/dataset/point_cloud_file.hpp"

#include "recording/file_cursor.hpp"

namespace traverse::dataset {

PointCloud read_ply(FileCursor& file);

}  // namespace traverse::dataset
