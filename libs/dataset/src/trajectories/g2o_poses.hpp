#pragma once

#include <string_view>

#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/files/text_file.hpp"

namespace traverse::dataset {

/// Whether a file whose first line is `line` is a pose graph of g2o.
bool is_g2o(std::string_view line);

/// The vertices of a pose graph in the order of their ids, which become the numbers of frames.
/// \throws files::InputError
void read_g2o(files::LineReader& reader, const PoseTaker& take, TrajectoryReading& reading);

}  // namespace traverse::dataset
