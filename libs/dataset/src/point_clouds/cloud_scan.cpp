#include "point_clouds/cloud_scan.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"

namespace traverse::dataset {

using files::InputError;
using files::Place;

namespace {

const FieldValues* first_of(const PointCloud& cloud, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (const FieldValues* field = cloud.find(name)) return field;
  }
  return nullptr;
}

std::vector<float> coordinate(const PointCloud& cloud, const char* name,
                              const std::filesystem::path& file) {
  const FieldValues* field = cloud.find(name);
  if (field == nullptr) {
    throw InputError(file, Place::whole_file(), "fields x, y and z", std::string("no ") + name);
  }
  return to_floats(*field);
}

std::vector<std::uint16_t> ring_numbers(const FieldValues& field,
                                        const std::filesystem::path& file) {
  if (const auto* stored = std::get_if<std::vector<std::uint16_t>>(&field)) return *stored;
  std::vector<std::uint16_t> rings;
  rings.reserve(size_of(field));
  for (const double value : to_doubles(field)) {
    if (!(value >= 0 && value <= std::numeric_limits<std::uint16_t>::max())) {
      throw InputError(file, Place::whole_file(), "ring numbers from 0 to 65535",
                       fmt::format("{}", value));
    }
    rings.push_back(static_cast<std::uint16_t>(value));
  }
  return rings;
}

}  // namespace

// CloudCompare puts "scalar_" before the names of fields.
const FieldValues* intensity_of(const PointCloud& cloud) {
  return first_of(cloud, {"intensity", "scalar_intensity"});
}
const FieldValues* ring_of(const PointCloud& cloud) {
  return first_of(cloud, {"ring", "scalar_ring"});
}

sensors::LidarScan scan_from_cloud(const PointCloud& cloud, geometry::Stamp stamp,
                                   const std::optional<PointTimeConvention>& time,
                                   const std::filesystem::path& file) {
  sensors::LidarScan scan;
  scan.stamp = stamp;
  scan.x = coordinate(cloud, "x", file);
  scan.y = coordinate(cloud, "y", file);
  scan.z = coordinate(cloud, "z", file);
  if (const FieldValues* intensity = intensity_of(cloud)) scan.intensity = to_floats(*intensity);
  if (const FieldValues* ring = ring_of(cloud)) scan.ring = ring_numbers(*ring, file);
  if (time) scan.time = point_times(cloud, *time, stamp, file);
  return scan;
}

PointCloud cloud_from_scan(const sensors::LidarScan& scan, DerivedPointData derived) {
  PointCloud cloud;
  cloud.add("x", scan.x);
  cloud.add("y", scan.y);
  cloud.add("z", scan.z);
  if (!scan.intensity.empty()) cloud.add("intensity", scan.intensity);
  if (!derived.ring.empty()) cloud.add("ring", std::move(derived.ring));
  if (!derived.time.empty()) cloud.add("time", std::move(derived.time));
  return cloud;
}

}  // namespace traverse::dataset
