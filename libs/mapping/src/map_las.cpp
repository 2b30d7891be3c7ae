#include "map_las.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>

#include "traverse/exports/coordinate_system.hpp"
#include "traverse/exports/gps_time.hpp"
#include "traverse/exports/las_writer.hpp"
#include "traverse/geodesy/map_grid.hpp"

namespace traverse::mapping {

namespace {

void tell_today(exports::LasDescription& description) {
  const auto today = std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now());
  const std::chrono::year_month_day date(today);
  const std::chrono::sys_days new_year = date.year() / std::chrono::January / 1;
  description.year = static_cast<int>(date.year());
  description.day_of_year = static_cast<int>((today - new_year).count()) + 1;
}

std::uint16_t intensity_of(float share) {
  return static_cast<std::uint16_t>(std::lround(65535 * std::clamp(share, 0.0F, 1.0F)));
}

}  // namespace

LasSummary write_las(const std::filesystem::path& file, const MapPoints& points,
                     const std::optional<geodesy::Geodetic>& origin, LasFrame frame) {
  LasSummary summary;
  exports::LasDescription description;
  std::optional<geodesy::MapGrid> grid;
  if (origin && frame == LasFrame::kGrid) {
    grid.emplace(*origin);
    description.wkt = exports::grid_wkt(*grid);
    // Whole metres: coordinates stay readable and whole millimetres stay whole.
    description.offset_m = grid->project(Eigen::Vector3d::Zero()).array().round();
    summary.frame = exports::name_of(*grid) + ", heights above the ellipsoid";
  } else if (origin) {
    description.wkt = exports::local_wkt(*origin);
    summary.frame = "east, north, up at the map's origin";
  } else {
    description.wkt = exports::local_wkt();
    summary.frame = "the map frame, tied to no place on earth";
  }
  description.generated_by = "Traverse";
  tell_today(description);
  // One clock for all of them: a file has one kind of time.
  description.is_gps_time = std::all_of(
      points.stamp.begin(), points.stamp.end(),
      [](geometry::Stamp stamp) { return exports::adjusted_gps_time(stamp).has_value(); });
  summary.has_gps_time = description.is_gps_time;

  constexpr std::uint16_t kUnknownRing = 255;
  exports::LasWriter writer(file, description);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d p_map(points.x[i], points.y[i], points.z[i]);
    exports::LasPoint point;
    point.position = grid ? grid->to_grid(p_map) : p_map;
    point.time_s = description.is_gps_time ? *exports::adjusted_gps_time(points.stamp[i])
                                           : points.stamp[i].seconds();
    point.intensity = intensity_of(points.intensity[i]);
    point.source = static_cast<std::uint16_t>(points.run[i] + 1);
    point.user_data = static_cast<std::uint8_t>(std::min(points.ring[i], kUnknownRing));
    writer.add(point);
  }
  writer.commit();
  return summary;
}

}  // namespace traverse::mapping
