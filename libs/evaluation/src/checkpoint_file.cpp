#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "traverse/evaluation/checkpoints.hpp"
#include "traverse/files/numbers.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/geodesy/local_tangent_plane.hpp"

namespace traverse::evaluation {

namespace {

using files::LineReader;

constexpr std::string_view kCheckpointColumns =
    "name; stamp_s, or from_s and to_s, or stop; e_m, n_m, h_m, or latitude_deg, longitude_deg, "
    "altitude_m; sigma_m or sigma_e_m, sigma_n_m, sigma_h_m; use";

/// A row of the table by the names of its columns.
class CheckpointRow {
 public:
  CheckpointRow(const LineReader& reader, const std::map<std::string, std::size_t>& columns)
      : reader_(reader), columns_(columns), cells_(files::split_cells(reader.line(), ',')) {
    if (cells_.size() < columns.size()) {
      throw reader.error(fmt::format("{} columns", columns.size()),
                         fmt::format("{}", cells_.size()));
    }
  }

  /// Empty where there is no such column, or nothing in it.
  std::string_view text(const std::string& column) const {
    const auto found = columns_.find(column);
    return found == columns_.end() ? std::string_view() : cells_[found->second];
  }
  double number(const std::string& column) const {
    const auto value = files::parse_double(text(column));
    if (value && std::isfinite(*value)) return *value;
    throw reader_.error("a number under " + column, files::in_quotes(text(column)));
  }
  double sigma(const std::string& column) const {
    const double value = number(column);
    if (value > 0) return value;
    throw reader_.error("a standard deviation above 0 under " + column,
                        files::in_quotes(text(column)));
  }
  geometry::Stamp stamp(const std::string& column) const {
    const auto value = geometry::parse_stamp_seconds(text(column));
    if (value) return *value;
    throw reader_.error("a time in seconds under " + column, files::in_quotes(text(column)));
  }
  files::InputError error(std::string expected, std::string found) const {
    return reader_.error(std::move(expected), std::move(found));
  }

 private:
  const LineReader& reader_;
  const std::map<std::string, std::size_t>& columns_;
  std::vector<std::string_view> cells_;
};

std::map<std::string, std::size_t> columns_of(const LineReader& reader) {
  static const std::set<std::string, std::less<>> kKnown{
      "name", "stamp_s",      "from_s",        "to_s",       "stop",       "e_m",
      "n_m",  "h_m",          "sigma_m",       "sigma_e_m",  "sigma_n_m",  "sigma_h_m",
      "use",  "latitude_deg", "longitude_deg", "altitude_m", "heading_deg"};
  // As the fixes of a receiver are written.
  static const std::map<std::string, std::string, std::less<>> kOfFixes{
      {"east_m", "sigma_e_m"}, {"north_m", "sigma_n_m"}, {"up_m", "sigma_h_m"}};
  std::map<std::string, std::size_t> columns;
  const auto cells = files::split_cells(reader.line(), ',');
  for (std::size_t i = 0; i < cells.size(); ++i) {
    std::string name(cells[i]);
    if (const auto of_fixes = kOfFixes.find(name); of_fixes != kOfFixes.end()) {
      name = of_fixes->second;
    }
    if (!kKnown.contains(name) || !columns.emplace(name, i).second) {
      throw reader.error(fmt::format("a header with the columns {}", kCheckpointColumns),
                         files::in_quotes(name));
    }
  }
  const bool is_geodetic = columns.contains("latitude_deg");
  const auto needed = is_geodetic ? std::array{"latitude_deg", "longitude_deg", "altitude_m"}
                                  : std::array{"e_m", "n_m", "h_m"};
  for (const char* name : needed) {
    if (columns.contains(name)) continue;
    throw reader.error(fmt::format("a header with the columns {}", kCheckpointColumns),
                       fmt::format("no {}", name));
  }
  return columns;
}

void take_moment(const CheckpointRow& row, Checkpoint& point) {
  if (!row.text("stamp_s").empty()) {
    point.stamp = row.stamp("stamp_s");
  } else if (!row.text("from_s").empty()) {
    point.stamp = row.stamp("from_s");
    point.until = row.stamp("to_s");
    if (*point.until < *point.stamp) {
      throw row.error("a to_s that is not before from_s", files::in_quotes(row.text("to_s")));
    }
  } else {
    const auto stop = files::parse_integer(row.text("stop"));
    if (!stop || *stop < 1) {
      throw row.error("a stamp_s, from_s and to_s, or the number of a stop from 1 on",
                      files::in_quotes(row.text("stop")));
    }
    point.stop = static_cast<std::size_t>(*stop);
  }
}

/// Where points are told by latitude and longitude: east, north and height at the first of them.
class PointGrid {
 public:
  Eigen::Vector3d place_of(const CheckpointRow& row, bool is_geodetic) {
    if (!is_geodetic) {
      const double e = row.number("e_m");
      const double n = row.number("n_m");
      const double h = row.number("h_m");
      return {e, n, h};
    }
    geodesy::Geodetic place;
    place.latitude_deg = row.number("latitude_deg");
    place.longitude_deg = row.number("longitude_deg");
    place.altitude_m = row.number("altitude_m");
    if (!(std::abs(place.latitude_deg) <= 90)) {
      throw row.error("a latitude_deg from -90 to 90", files::in_quotes(row.text("latitude_deg")));
    }
    if (!plane_) plane_.emplace(place);
    return plane_->to_enu(place);
  }

 private:
  std::optional<geodesy::LocalTangentPlane> plane_;
};

Eigen::Vector3d sigmas_of(const CheckpointRow& row) {
  if (!row.text("sigma_m").empty()) return Eigen::Vector3d::Constant(row.sigma("sigma_m"));
  if (row.text("sigma_e_m").empty()) return Eigen::Vector3d::Zero();
  const double e = row.sigma("sigma_e_m");
  const double n = row.sigma("sigma_n_m");
  const double h = row.sigma("sigma_h_m");
  return {e, n, h};
}

}  // namespace

std::vector<Checkpoint> read_checkpoints(const std::filesystem::path& file) {
  LineReader reader(file);
  if (!reader.next()) {
    throw files::InputError(file, files::Place::whole_file(),
                            fmt::format("a table with the columns {}", kCheckpointColumns),
                            "an empty file");
  }
  const auto columns = columns_of(reader);
  std::vector<Checkpoint> points;
  std::set<std::string> names;
  PointGrid grid;
  while (reader.next()) {
    const CheckpointRow row(reader, columns);
    Checkpoint point;
    point.name = columns.contains("name") ? std::string(row.text("name"))
                                          : std::to_string(points.size() + 1);
    if (point.name.empty() || !names.insert(point.name).second) {
      throw reader.error("a name that no other point has", files::in_quotes(point.name));
    }
    take_moment(row, point);
    point.p_enh = grid.place_of(row, columns.contains("latitude_deg"));
    point.sigma_m = sigmas_of(row);
    const std::string_view use = row.text("use");
    if (!use.empty() && use != "control" && use != "check") {
      throw reader.error("control or check under use", files::in_quotes(use));
    }
    point.is_control = use == "control";
    points.push_back(std::move(point));
  }
  if (points.empty()) {
    throw files::InputError(file, files::Place::whole_file(), "at least one point", "none");
  }
  return points;
}

}  // namespace traverse::evaluation
