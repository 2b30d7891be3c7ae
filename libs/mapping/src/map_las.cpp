#include "map_las.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>

#include "traverse/exports/coordinate_system.hpp"
#include "traverse/exports/gps_time.hpp"

namespace traverse::mapping {

namespace {

void tell_today(exports::LasDescription& description) {
  const auto today = std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now());
  const std::chrono::year_month_day date(today);
  const std::chrono::sys_days new_year = date.year() / std::chrono::January / 1;
  description.year = static_cast<int>(date.year());
  description.day_of_year = static_cast<int>((today - new_year).count()) + 1;
}

}  // namespace

LasCoordinates::LasCoordinates(const std::optional<geodesy::Geodetic>& origin, LasFrame frame) {
  if (origin && frame == LasFrame::kGrid) {
    grid.emplace(*origin);
    description.wkt = exports::grid_wkt(*grid);
    // Whole metres: coordinates stay readable and whole millimetres stay whole.
    description.offset_m = grid->project(Eigen::Vector3d::Zero()).array().round();
    in_words = exports::name_of(*grid) + ", heights above the ellipsoid";
  } else if (origin) {
    description.wkt = exports::local_wkt(*origin);
    in_words = "east, north, up at the map's origin";
  } else {
    description.wkt = exports::local_wkt();
    in_words = "the map frame, tied to no place on earth";
  }
  description.generated_by = "Traverse";
  tell_today(description);
}

Eigen::Vector3d LasCoordinates::operator()(const Eigen::Vector3d& p_map) {
  return grid ? grid->to_grid(p_map) : p_map;
}

std::uint16_t las_intensity(float share) {
  return static_cast<std::uint16_t>(std::lround(65535 * std::clamp(share, 0.0F, 1.0F)));
}

LasSummary write_las(const std::filesystem::path& file, const MapPoints& points,
                     const std::optional<geodesy::Geodetic>& origin, LasFrame frame) {
  LasCoordinates coordinates(origin, frame);
  // One clock for all of them: a file has one kind of time.
  const bool is_gps_time = std::all_of(
      points.stamp.begin(), points.stamp.end(),
      [](geometry::Stamp stamp) { return exports::adjusted_gps_time(stamp).has_value(); });
  coordinates.description.is_gps_time = is_gps_time;

  exports::LasWriter writer(file, coordinates.description);
  for (std::size_t i = 0; i < points.size(); ++i) {
    exports::LasPoint point;
    point.position = coordinates({points.x[i], points.y[i], points.z[i]});
    point.time_s =
        is_gps_time ? *exports::adjusted_gps_time(points.stamp[i]) : points.stamp[i].seconds();
    point.intensity = las_intensity(points.intensity[i]);
    point.source = static_cast<std::uint16_t>(points.run[i] + 1);
    point.user_data =
        static_cast<std::uint8_t>(std::min<std::uint16_t>(points.ring[i], kUnknownLasRing));
    writer.add(point);
  }
  writer.commit();
  return {coordinates.in_words, is_gps_time};
}

}  // namespace traverse::mapping
