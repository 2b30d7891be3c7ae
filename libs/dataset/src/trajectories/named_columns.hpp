#pragma once

#include <string>
#include <string_view>

#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/files/text_file.hpp"

namespace traverse::dataset {

/// Whether a line is a header that names the columns of poses.
bool names_columns(std::string_view line);
/// Whether it names whole seconds and nanoseconds in two columns too, also in a comment.
bool names_nanoseconds_beside_seconds(std::string_view line);

/// A table whose columns are named, by its header or by `columns` (TrajectoryChoice).
/// \throws files::InputError
void read_named_columns(files::LineReader& reader, const std::string& columns,
                        const PoseTaker& take, TrajectoryReading& reading);

}  // namespace traverse::dataset
