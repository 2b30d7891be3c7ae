#include "geodetic_path.hpp"

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/geometry/stamp.hpp"

namespace traverse::pipeline {

namespace {

constexpr const char* kBeginKml = R"(<?xml version="1.0" encoding="UTF-8"?>
<kml xmlns="http://www.opengis.net/kml/2.2"><Document>
<name>Path of the vehicle</name>
<Style id="path"><LineStyle><color>ffb27200</color><width>3</width></LineStyle></Style>
<Placemark><name>path</name><styleUrl>#path</styleUrl>
<LineString><tessellate>1</tessellate><altitudeMode>clampToGround</altitudeMode><coordinates>
)";
constexpr const char* kEndKml = "</coordinates></LineString></Placemark>\n</Document></kml>\n";

}  // namespace

void write_geodetic_path(const geometry::Trajectory& T_map_body, const geodesy::Geodetic& origin,
                         const RunFolder& folder) {
  constexpr double kLineStep_m = 0.1;  // a line for maps needs no more
  const geodesy::LocalTangentPlane map(origin);
  std::string table = "stamp_s,latitude_deg,longitude_deg,altitude_m\n";
  std::string line = kBeginKml;
  Eigen::Vector3d drawn = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < T_map_body.size(); ++k) {
    const Eigen::Vector3d& p = T_map_body.pose(k).translation;
    if (!p.allFinite()) continue;
    const geodesy::Geodetic place = map.to_geodetic(p);
    // A tenth of a millimetre: 1e-9 degrees.
    table += fmt::format("{},{:.9f},{:.9f},{:.4f}\n", geometry::to_text(T_map_body.stamp(k)),
                         place.latitude_deg, place.longitude_deg, place.altitude_m);
    const bool is_drawn = k == 0 || k + 1 == T_map_body.size() || (p - drawn).norm() >= kLineStep_m;
    if (!is_drawn) continue;
    drawn = p;
    line += fmt::format("{:.9f},{:.9f},{:.3f}\n", place.longitude_deg, place.latitude_deg,
                        place.altitude_m);
  }
  files::write_text(folder.geodetic_path(), table);
  files::write_text(folder.geodetic_line(), line + kEndKml);
}

}  // namespace traverse::pipeline
