#pragma once

#include <vector>

#include "traverse/dataset/point_cloud_file.hpp"

#include "recording/file_cursor.hpp"

namespace traverse::dataset {

/// One column of an ascii table of points: the words it takes a line, and where they go.
struct AsciiColumn {
  std::size_t words = 1;
  FieldValues* values = nullptr;     ///< null: the column is passed over
  bool may_hold_other_text = false;  ///< then the column is left out
  bool is_left_out = false;          ///< one of its words was no number of the type
};

/// Reads one line a point, `points` of them; blank lines are passed over.
/// \throws files::InputError naming the line.
void read_ascii_points(FileCursor& file, std::size_t points, std::vector<AsciiColumn>& columns);

}  // namespace traverse::dataset
