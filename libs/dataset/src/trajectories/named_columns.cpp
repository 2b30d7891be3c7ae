#include "trajectories/named_columns.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/files/numbers.hpp"

#include "trajectories/pose_sequence.hpp"

namespace traverse::dataset {

namespace {

using geometry::Stamp;

constexpr std::array<std::string_view, 8> kPoseColumns{"t", "x", "y", "z", "qx", "qy", "qz", "qw"};
constexpr std::string_view kOtherColumn = "_";

/// Other names of the columns: whole ones, and ends of those that `rostopic echo -p` and tools like
/// it write ("field.pose.pose.position.x").
constexpr std::array<std::array<std::string_view, 6>, 8> kColumnNames{
    {{"t", "time", "timestamp", "stamp", "ts", "sec"},
     {"x", "tx", "px", "pos_x", "position_x", "p_x"},
     {"y", "ty", "py", "pos_y", "position_y", "p_y"},
     {"z", "tz", "pz", "pos_z", "position_z", "p_z"},
     {"qx", "q_x", "quat_x", "orientation_x", "rotation_x", "rot_x"},
     {"qy", "q_y", "quat_y", "orientation_y", "rotation_y", "rot_y"},
     {"qz", "q_z", "quat_z", "orientation_z", "rotation_z", "rot_z"},
     {"qw", "q_w", "quat_w", "orientation_w", "rotation_w", "rot_w"}}};
constexpr std::array<std::string_view, 8> kEnds{
    ".header.stamp",  ".position.x",    ".position.y",    ".position.z",
    ".orientation.x", ".orientation.y", ".orientation.z", ".orientation.w"};

/// Units that a column's name tells, and what parses the times.
constexpr std::array<std::pair<std::string_view, geometry::UnixTimeUnit>, 4> kTimeUnits{
    {{"_ns", geometry::UnixTimeUnit::kNanoseconds},
     {"_us", geometry::UnixTimeUnit::kMicroseconds},
     {"_ms", geometry::UnixTimeUnit::kMilliseconds},
     {"_s", geometry::UnixTimeUnit::kSeconds}}};

char separator_of(std::string_view line) {
  for (const char separator : {',', ';'}) {
    if (line.find(separator) != std::string_view::npos) return separator;
  }
  return ' ';
}

std::vector<std::string_view> cells_of(std::string_view line, char separator) {
  return separator == ' ' ? files::split_words(line) : files::split_cells(line, separator);
}

/// What is added to a column of whole seconds.
constexpr std::array<std::string_view, 4> kNanosecondColumns{"nsec", "nsecs", "nanosec",
                                                             "nanoseconds"};

/// In lower case, without quotes and the marks of a comment; a unit in brackets as a suffix.
std::string column_name_of(std::string_view cell) {
  std::string name;
  for (const char c : cell) {
    if (c == '"' || c == '\'' || c == '#' || c == '%' || c == ']' || c == ')') continue;
    if (c == '[' || c == '(') {
      while (!name.empty() && (name.back() == ' ' || name.back() == '_')) name.pop_back();
      name += '_';
    } else {
      name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  return name;
}

struct ColumnMeaning {
  std::size_t column = 0;                                     ///< index in kPoseColumns
  std::optional<geometry::UnixTimeUnit> unit = std::nullopt;  ///< of times, where the name tells
  bool overrules = false;  ///< the stamp of a header, which stands behind the time of the log
};

std::optional<ColumnMeaning> meaning_of(const std::string& name) {
  const auto is_of = [&](std::string_view candidate, std::size_t k) {
    return std::find(kColumnNames[k].begin(), kColumnNames[k].end(), candidate) !=
               kColumnNames[k].end() ||
           candidate.ends_with(kEnds[k]);
  };
  std::string without_unit = name;
  if (name.ends_with("_m")) without_unit.resize(name.size() - 2);
  for (std::size_t k = 0; k < kPoseColumns.size(); ++k) {
    if (!is_of(name, k) && (k == 0 || !is_of(without_unit, k))) continue;
    return ColumnMeaning{k, std::nullopt, k == 0 && name.ends_with(kEnds[0])};
  }
  for (const auto& [suffix, unit] : kTimeUnits) {
    if (!name.ends_with(suffix)) continue;
    if (is_of(name.substr(0, name.size() - suffix.size()), 0)) return ColumnMeaning{0, unit};
  }
  return std::nullopt;
}

/// Where the columns of a pose stand, and how times are to be read.
struct Layout {
  std::array<std::optional<std::size_t>, 8> at;
  std::optional<geometry::UnixTimeUnit> unit;
  std::optional<std::size_t> nanoseconds;  ///< beside a column of whole seconds
  std::size_t columns = 0;

  void add(const ColumnMeaning& meaning, std::size_t index) {
    if (at[meaning.column] && !meaning.overrules) return;  // the first of its kind
    at[meaning.column] = index;
    if (meaning.unit) unit = meaning.unit;
  }
  std::vector<std::string_view> missing() const {
    std::vector<std::string_view> names;
    for (std::size_t k = 0; k < at.size(); ++k) {
      if (!at[k]) names.push_back(kPoseColumns[k]);
    }
    return names;
  }
};

/// A header may stand in a comment.
std::string_view without_mark(std::string_view line) {
  const std::size_t begin = line.find_first_not_of("#% \t");
  return begin == std::string_view::npos ? std::string_view() : line.substr(begin);
}

bool is_of_nanoseconds(const std::string& name) {
  return std::find(kNanosecondColumns.begin(), kNanosecondColumns.end(), name) !=
         kNanosecondColumns.end();
}

Layout layout_of_header(std::string_view line) {
  const auto cells = cells_of(line, separator_of(line));
  Layout layout;
  layout.columns = cells.size();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string name = column_name_of(cells[i]);
    if (const auto meaning = meaning_of(name)) layout.add(*meaning, i);
    if (is_of_nanoseconds(name) && !layout.nanoseconds) layout.nanoseconds = i;
  }
  return layout;
}

bool is_header(std::string_view line) {
  const auto cells = cells_of(line, separator_of(line));
  return !cells.empty() && !files::parse_double(cells.front());
}

/// The layout that the user names. \param header of the file, if it has one
Layout layout_as_named(const std::string& columns, const std::optional<std::string>& header) {
  const auto fail = [&](const std::string& found) {
    return files::InputError(
        "--columns", files::Place::whole_file(),
        fmt::format("names of t (or t_ms, t_us, t_ns), x, y, z, qx, qy, qz, qw, in the order of "
                    "the columns with {} for others, or as t=NAME,x=NAME",
                    kOtherColumn),
        found);
  };
  Layout layout;
  const auto items = files::split_cells(columns, ',');
  layout.columns = items.size();
  std::vector<std::string> names;
  if (header) {
    for (const auto cell : cells_of(*header, separator_of(*header))) {
      names.push_back(column_name_of(cell));
    }
    layout.columns = names.size();
  }
  for (std::size_t i = 0; i < items.size(); ++i) {
    const std::string_view item = items[i];
    if (item == kOtherColumn) continue;
    const std::size_t equals = item.find('=');
    const std::string name = column_name_of(item.substr(0, equals));
    if (equals == std::string_view::npos && is_of_nanoseconds(name)) {
      layout.nanoseconds = i;
      continue;
    }
    const auto meaning = meaning_of(name);
    if (!meaning) throw fail(files::in_quotes(item));
    std::size_t index = i;
    if (equals != std::string_view::npos) {
      const auto found =
          std::find(names.begin(), names.end(), column_name_of(item.substr(equals + 1)));
      if (found == names.end()) {
        throw fail(fmt::format("{}; the file's header names {}", files::in_quotes(item),
                               names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
      }
      index = static_cast<std::size_t>(found - names.begin());
    }
    layout.add(*meaning, index);
  }
  if (const auto missing = layout.missing(); !missing.empty()) {
    throw fail(fmt::format("{} without {}", files::in_quotes(columns), fmt::join(missing, ", ")));
  }
  return layout;
}

/// A time of a column whose name tells no unit is one of seconds, unless it is a Unix time of
/// another by its size.
Stamp stamp_in(const files::LineReader& reader, std::string_view text, const Layout& layout) {
  const double number = finite_number(reader, text);
  const auto unit = layout.unit ? layout.unit : geometry::unix_time_unit(number);
  const auto stamp =
      unit ? geometry::parse_unix_time(text, *unit) : geometry::parse_stamp_seconds(text);
  if (!stamp) throw reader.error("a time", files::in_quotes(text));
  return *stamp;
}

}  // namespace

bool names_columns(std::string_view line) {
  const std::string_view names = without_mark(line);
  return is_header(names) && layout_of_header(names).missing().empty();
}

bool names_nanoseconds_beside_seconds(std::string_view line) {
  return names_columns(line) && layout_of_header(without_mark(line)).nanoseconds.has_value();
}

void read_named_columns(files::LineReader& reader, const std::string& columns,
                        const PoseTaker& take, TrajectoryReading& reading) {
  std::optional<std::string> header;
  do {
    if (!reader.next(files::LineReader::Comments::kGive)) return;
    const std::string_view text = without_mark(reader.line());
    if (is_header(text)) header = text;
  } while (reader.line().starts_with('#') && !names_columns(reader.line()));
  if (header && !is_header(without_mark(reader.line()))) header.reset();
  Layout layout;
  if (!columns.empty()) {
    layout = layout_as_named(columns, header);
  } else {
    if (header) layout = layout_of_header(*header);
    if (const auto missing = layout.missing(); !missing.empty()) {
      throw reader.error(
          "a header that names the columns t, x, y, z, qx, qy, qz and qw (or --columns)",
          header ? fmt::format("no {} in {}", fmt::join(missing, ", "), files::in_quotes(*header))
                 : "numbers");
    }
  }
  PosesInOrder poses(take, false);
  bool at_row = !header;
  while (at_row || reader.next()) {
    at_row = false;
    const auto cells = cells_of(reader.line(), separator_of(reader.line()));
    if (cells.size() < layout.columns) {
      throw reader.error(fmt::format("{} columns", layout.columns),
                         fmt::format("{}", cells.size()));
    }
    const auto number = [&](std::size_t k) { return finite_number(reader, cells[*layout.at[k]]); };
    const Eigen::Vector3d p(number(1), number(2), number(3));
    const Eigen::Vector4d q(number(4), number(5), number(6), number(7));
    Stamp stamp = stamp_in(reader, cells[*layout.at[0]], layout);
    if (layout.nanoseconds) {
      const auto more = files::parse_integer(cells[*layout.nanoseconds]);
      if (!more || *more < 0 || *more >= 1'000'000'000) {
        throw reader.error("nanoseconds of a second", files::in_quotes(cells[*layout.nanoseconds]));
      }
      stamp.nanoseconds += *more;
    }
    poses.add(reader, stamp, p, q);
  }
  reading.notes = poses.notes();
}

}  // namespace traverse::dataset
