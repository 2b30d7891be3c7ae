#include "point_clouds/point_names.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace traverse::dataset {

namespace {

// Of PCL and Velodyne, Ouster, Hesai, Livox, PDAL and LAS.
constexpr std::array<std::string_view, 14> kTimeNames{
    "time",        "t",           "timestamp",  "time_stamp", "timestamps",
    "offset_time", "time_offset", "timeoffset", "point_time", "relative_time",
    "gpstime",     "gps_time",    "stamp",      "offset"};
constexpr std::array<std::pair<std::string_view, double>, 10> kUnitSuffixes{{{"_s", 1},
                                                                             {"_sec", 1},
                                                                             {"_ms", 1e-3},
                                                                             {"_msec", 1e-3},
                                                                             {"_us", 1e-6},
                                                                             {"_usec", 1e-6},
                                                                             {"_ns", 1e-9},
                                                                             {"_nsec", 1e-9},
                                                                             {"_nanosec", 1e-9},
                                                                             {"_nanos", 1e-9}}};
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kPairSuffixes{
    {{"sec", "nsec"}, {"s", "ns"}, {"sec", "nanosec"}}};

const PointColumn* column_called(const PointColumns& points, std::string_view name) {
  for (const PointColumn& column : points.columns) {
    if (plain_name(column.name) == name) return &column;
  }
  return nullptr;
}

}  // namespace

std::string plain_name(std::string_view name) {
  constexpr std::string_view kCloudCompare = "scalar_";
  std::string plain(name);
  std::transform(plain.begin(), plain.end(), plain.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (plain.starts_with(kCloudCompare)) plain.erase(0, kCloudCompare.size());
  return plain;
}

std::vector<const PointColumn*> columns_called(const PointColumns& points,
                                               std::initializer_list<std::string_view> names) {
  std::vector<const PointColumn*> found;
  for (const std::string_view name : names) {
    if (const PointColumn* column = column_called(points, name)) found.push_back(column);
  }
  return found;
}

std::vector<const PointColumn*> ring_columns(const PointColumns& points) {
  return columns_called(
      points, {"ring", "ring_id", "laser_id", "laserid", "channel", "line", "beam", "beam_id"});
}

std::vector<const PointColumn*> intensity_columns(const PointColumns& points) {
  return columns_called(points, {"intensity", "reflectivity", "remission", "reflectance", "i"});
}

std::vector<TimeColumn> time_columns(const PointColumns& points) {
  std::vector<TimeColumn> found;
  const auto add_pair = [&](const std::string& seconds, const std::string& nanoseconds) {
    const PointColumn* whole = column_called(points, seconds);
    const PointColumn* rest = column_called(points, nanoseconds);
    if (whole != nullptr && rest != nullptr) found.push_back({whole, rest, 1.0});
  };
  for (const auto& [seconds, nanoseconds] : kPairSuffixes) {
    for (const std::string_view name : kTimeNames) {
      add_pair(std::string(name) + "_" + std::string(seconds),
               std::string(name) + "_" + std::string(nanoseconds));
    }
    add_pair(std::string(seconds), std::string(nanoseconds));
  }
  const auto add = [&](const std::string& name, std::optional<double> unit_s) {
    const PointColumn* column = column_called(points, name);
    const bool is_in_pair = std::any_of(found.begin(), found.end(), [&](const TimeColumn& pair) {
      return pair.column == column || pair.nanoseconds == column;
    });
    if (column != nullptr && !is_in_pair) found.push_back({column, nullptr, unit_s});
  };
  for (const std::string_view name : kTimeNames) {
    if (name != "offset") add(std::string(name), std::nullopt);
    for (const auto& [suffix, unit_s] : kUnitSuffixes) {
      add(std::string(name) + std::string(suffix), unit_s);
    }
  }
  add("curvature", 1e-3);
  return found;
}

bool may_be_needed(std::string_view name) {
  PointColumns one;
  one.columns.emplace_back();
  one.columns.back().name = name;
  return !columns_called(one, {"x", "y", "z"}).empty() || !ring_columns(one).empty() ||
         !intensity_columns(one).empty() || sounds_like_time(name) || !time_columns(one).empty();
}

bool sounds_like_time(std::string_view name) {
  const std::string plain = plain_name(name);
  for (const char* part : {"time", "stamp", "sec"}) {
    if (plain.find(part) != std::string::npos) return true;
  }
  return false;
}

}  // namespace traverse::dataset
