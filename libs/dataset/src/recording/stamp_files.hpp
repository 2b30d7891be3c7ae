#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "traverse/geometry/stamp.hpp"

namespace traverse::dataset {

/// A stamp as it stands in a file of stamps or as a file's name.
struct StampText {
  geometry::Stamp stamp;
  std::string
      form;  ///< "seconds", "nanoseconds, told by their size", "dates and times of day, UTC"
};

/// Seconds ("0.1033", "1317042145.964"), a Unix time in whole milli-, micro- or nanoseconds, which
/// no number of seconds is as large as, or, as in KITTI raw, a date and time of day taken as UTC
/// ("2011-09-26 13:02:25.964389445"). Nothing if `text` is none of these.
std::optional<StampText> parse_stamp(std::string_view text);

struct StampFile {
  std::filesystem::path file;
  /// One a line. A line that holds none keeps its place as nothing, so that the others keep theirs;
  /// blank lines at the end and '#' comments do not count.
  std::vector<std::optional<geometry::Stamp>> stamps;
  std::string form;  ///< of the first stamp
};

/// "times.txt", and where they are not seconds "times.txt (nanoseconds, told by their size)".
std::string name_with_form(const StampFile& file);

/// \throws files::InputError if the file cannot be read.
StampFile read_stamps(const std::filesystem::path& file);

}  // namespace traverse::dataset
