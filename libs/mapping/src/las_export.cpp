#include "traverse/mapping/las_export.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <variant>
#include <vector>

#include "traverse/dataset/ply_blocks.hpp"
#include "traverse/exports/gps_time.hpp"
#include "traverse/exports/las_writer.hpp"
#include "traverse/files/input_error.hpp"

#include "map_las.hpp"

namespace traverse::mapping {

namespace {

/// A field's values as doubles, or none.
std::vector<double> values_of(const dataset::PointCloud& cloud, const char* name) {
  const dataset::FieldValues* values = cloud.find(name);
  return values == nullptr ? std::vector<double>() : dataset::to_doubles(*values);
}

/// By the names that programs give it.
const dataset::FieldValues* intensity_of(const dataset::PointCloud& cloud) {
  for (const char* name : {"intensity", "scalar_Intensity", "reflectivity"}) {
    if (const auto* values = cloud.find(name)) return values;
  }
  return nullptr;
}

/// What an intensity of 1 is in this field: whole numbers of one byte count to 255, of two to
/// 65535.
double full_scale(const dataset::FieldValues& values) {
  return std::visit(
      [](const auto& v) {
        using Value = typename std::decay_t<decltype(v)>::value_type;
        if constexpr (std::is_floating_point_v<Value>) return 1.0;
        return sizeof(Value) == 1 ? 255.0 : 65535.0;
      },
      values);
}

/// Whether the times of these points are dates. They are all of one clock.
bool are_dates(const std::vector<double>& times) {
  return !times.empty() &&
         exports::adjusted_gps_time(geometry::Stamp::from_seconds(times.front())).has_value();
}

}  // namespace

LasExport export_las(const std::filesystem::path& ply,
                     const std::optional<geodesy::Geodetic>& origin, LasFrame frame,
                     const std::filesystem::path& las,
                     const std::function<void(double share)>& progress) {
  LasExport result;
  LasCoordinates coordinates(origin, frame);
  result.frame = coordinates.in_words;
  dataset::PlyBlocks blocks(ply);
  std::optional<exports::LasWriter> writer;
  std::uint64_t done = 0;
  while (const auto cloud = blocks.next()) {
    const auto x = values_of(*cloud, "x");
    const auto y = values_of(*cloud, "y");
    const auto z = values_of(*cloud, "z");
    if (x.empty() || y.empty() || z.empty()) {
      throw files::InputError(ply, files::Place::whole_file(), "points with x, y and z",
                              "a PLY file without one of them");
    }
    const auto time = values_of(*cloud, "time");
    const auto ring = values_of(*cloud, "ring");
    const dataset::FieldValues* as_stored = intensity_of(*cloud);
    const auto intensity =
        as_stored == nullptr ? std::vector<double>() : dataset::to_doubles(*as_stored);
    const double full = as_stored == nullptr ? 1 : full_scale(*as_stored);
    if (!writer) {
      result.has_time = !time.empty();
      result.has_gps_time = are_dates(time);
      coordinates.description.is_gps_time = result.has_gps_time;
      writer.emplace(las, coordinates.description);
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (!std::isfinite(x[i]) || !std::isfinite(y[i]) || !std::isfinite(z[i])) {
        ++result.left_out;
        continue;
      }
      exports::LasPoint point;
      point.position = coordinates({x[i], y[i], z[i]});
      if (!time.empty()) {
        const auto stamp = geometry::Stamp::from_seconds(time[i]);
        point.time_s =
            result.has_gps_time ? exports::adjusted_gps_time(stamp).value_or(0) : time[i];
      }
      if (!intensity.empty())
        point.intensity = las_intensity(static_cast<float>(intensity[i] / full));
      point.source = 1;
      point.user_data = ring.empty() ? kUnknownLasRing
                                     : static_cast<std::uint8_t>(std::clamp(
                                           ring[i], 0.0, static_cast<double>(kUnknownLasRing)));
      writer->add(point);
    }
    done += x.size();
    if (progress) progress(static_cast<double>(done) / static_cast<double>(blocks.size()));
  }
  if (!writer) writer.emplace(las, coordinates.description);
  result.points = writer->size();
  writer->commit();
  return result;
}

}  // namespace traverse::mapping
