#pragma once

#include <iosfwd>

#include "traverse/geometry/trajectory.hpp"

namespace traverse::dataset {

/// What write_tum() and write_kitti() put into files, for files that are written with others.
/// \throws std::invalid_argument as they do
void write_tum(std::ostream& stream, const geometry::Trajectory& T_map_body);
void write_kitti(std::ostream& stream, const geometry::Trajectory& T_map_body);

}  // namespace traverse::dataset
