#include "navigation_log/known_columns.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"

#include "navigation_log/csv_rows.hpp"
#include "point_clouds/scan_files.hpp"

namespace traverse::dataset {

namespace {

namespace fs = std::filesystem;
using Names = std::initializer_list<std::string_view>;

constexpr std::array<std::string_view, 6> kTimeNames{"t",           "time",   "timestamp",
                                                     "timestamp_s", "time_s", "stamp"};

std::string lowered(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

/// The columns of a table's header: its first line, comment or not.
class TableHeader {
 public:
  explicit TableHeader(const fs::path& file) {
    files::LineReader reader(file);
    if (!reader.next(files::LineReader::Comments::kGive)) return;
    for (const auto cell : files::split_cells(reader.line(), ',')) {
      columns_.push_back(CsvColumn::of(cell).name);
    }
  }

  std::optional<std::string> find(Names names) const {
    for (const std::string_view name : names) {
      for (const std::string& column : columns_) {
        if (lowered(column) == lowered(name)) return column;
      }
    }
    return std::nullopt;
  }
  std::optional<std::string> time() const {
    for (const std::string_view name : kTimeNames) {
      if (auto found = find({name})) return found;
    }
    return std::nullopt;
  }
  /// Three columns that are named alike.
  std::optional<std::string> find_three(
      std::initializer_list<std::array<std::string_view, 3>> of) const {
    for (const auto& names : of) {
      const auto x = find({names[0]});
      const auto y = find({names[1]});
      const auto z = find({names[2]});
      if (x && y && z) return fmt::format("{},{},{}", *x, *y, *z);
    }
    return std::nullopt;
  }

 private:
  std::vector<std::string> columns_;
};

std::optional<fs::path> first_of_these(const fs::path& folder,
                                       const std::vector<std::string_view>& names) {
  for (const std::string_view name : names) {
    if (fs::is_regular_file(folder / name)) return fs::path(name);
  }
  return std::nullopt;
}

void add_reason(KnownTables& tables, const fs::path& file) {
  if (!tables.reason.empty()) tables.reason += ", ";
  tables.reason += file.generic_string();
}

bool take_imu(const fs::path& folder, const fs::path& file, KnownTables& tables) {
  const TableHeader header(folder / file);
  const auto time = header.time();
  const auto gyro =
      header.find_three({{"gx", "gy", "gz"},
                         {"wx", "wy", "wz"},
                         {"gyro_x", "gyro_y", "gyro_z"},
                         {"angular_velocity_x", "angular_velocity_y", "angular_velocity_z"},
                         {"w_RS_S_x", "w_RS_S_y", "w_RS_S_z"}});
  const auto force = header.find_three(
      {{"ax", "ay", "az"},
       {"acc_x", "acc_y", "acc_z"},
       {"accel_x", "accel_y", "accel_z"},
       {"linear_acceleration_x", "linear_acceleration_y", "linear_acceleration_z"},
       {"a_RS_S_x", "a_RS_S_y", "a_RS_S_z"}});
  if (!time || !gyro || !force) return false;
  tables.csv.gyro = {file.generic_string(), *time, *gyro, 0};
  tables.csv.accelerometer = {file.generic_string(), *time, *force, 0};
  return true;
}

bool take_gnss(const fs::path& folder, const fs::path& file, KnownTables& tables) {
  const TableHeader header(folder / file);
  const auto time = header.time();
  const auto latitude = header.find({"lat", "latitude", "latitude_deg", "lat_deg"});
  const auto longitude = header.find({"lon", "lng", "longitude", "longitude_deg", "lon_deg"});
  const auto altitude = header.find({"alt", "altitude", "altitude_m", "alt_m", "height"});
  if (!time || !latitude || !longitude || !altitude) return false;
  std::string columns = fmt::format("{},{},{}", *latitude, *longitude, *altitude);
  const auto heading = header.find({"heading_deg"});
  const auto sigmas = header.find_three({{"east_sigma_m", "north_sigma_m", "up_sigma_m"}});
  if (heading) columns += "," + *heading;
  if (heading && sigmas) columns += "," + *sigmas;
  tables.csv.gnss = {file.generic_string(), *time, columns, 0};
  return true;
}

bool take_wheels(const fs::path& folder, const fs::path& file, KnownTables& tables) {
  const TableHeader header(folder / file);
  const auto time = header.time();
  const auto speed = header.find({"v", "vx", "speed", "speed_m_s", "velocity"});
  const auto left = header.find({"left", "v_left", "left_m_s", "speed_left"});
  const auto right = header.find({"right", "v_right", "right_m_s", "speed_right"});
  if (!time || (!speed && !(left && right))) return false;
  tables.csv.wheels = {file.generic_string(), *time,
                       speed ? *speed : fmt::format("{},{}", *left, *right), 0};
  return true;
}

}  // namespace

KnownTables known_tables(const fs::path& folder) {
  KnownTables tables;
  using Take = bool (*)(const fs::path&, const fs::path&, KnownTables&);
  struct Kind {
    std::vector<std::string_view> names;
    Take take;
  };
  const std::array<Kind, 3> kinds{
      Kind{{"imu.csv", "imu0/data.csv", "mav0/imu0/data.csv"}, take_imu},
      Kind{{"gnss.csv", "gps.csv"}, take_gnss}, Kind{{"wheels.csv", "odom.csv"}, take_wheels}};
  for (const Kind& kind : kinds) {
    const auto file = first_of_these(folder, kind.names);
    if (!file) continue;
    if (kind.take(folder, *file, tables)) {
      add_reason(tables, *file);
    } else if (tables.not_understood.empty()) {
      tables.not_understood = file->generic_string();
    }
  }
  if (!tables.csv.gyro.file.empty()) return tables;
  for (const fs::path& file : files_with_extension(folder, ".csv")) {
    if (const auto euroc = euroc_imu_statements(file)) {
      tables.csv.gyro = euroc->gyro;
      tables.csv.accelerometer = euroc->accelerometer;
      add_reason(tables, file.filename());
      break;
    }
  }
  return tables;
}

}  // namespace traverse::dataset
