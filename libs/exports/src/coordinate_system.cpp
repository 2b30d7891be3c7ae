#include "traverse/exports/coordinate_system.hpp"

#include <fmt/format.h>

namespace traverse::exports {

namespace {

constexpr const char* kWgs84 =
    R"(GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563,)"
    R"(AUTHORITY["EPSG","7030"]],AUTHORITY["EPSG","6326"]],)"
    R"(PRIMEM["Greenwich",0,AUTHORITY["EPSG","8901"]],)"
    R"(UNIT["degree",0.0174532925199433,AUTHORITY["EPSG","9122"]],AUTHORITY["EPSG","4326"]])";
constexpr const char* kMetre = R"(UNIT["metre",1,AUTHORITY["EPSG","9001"]])";

std::string projected_wkt(const geodesy::MapGrid& grid) {
  const bool north = grid.is_north();
  if (grid.zone() == 0) {
    const char* away = north ? "SOUTH" : "NORTH";  // every way from a pole
    return fmt::format(
        R"(PROJCS["{}",{},PROJECTION["Polar_Stereographic"],PARAMETER["latitude_of_origin",{}],)"
        R"(PARAMETER["central_meridian",0],PARAMETER["scale_factor",0.994],)"
        R"(PARAMETER["false_easting",2000000],PARAMETER["false_northing",2000000],{},)"
        R"(AXIS["Easting",{}],AXIS["Northing",{}],AUTHORITY["EPSG","{}"]])",
        name_of(grid), kWgs84, north ? 90 : -90, kMetre, away, away, grid.epsg());
  }
  return fmt::format(
      R"(PROJCS["{}",{},PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],)"
      R"(PARAMETER["central_meridian",{}],PARAMETER["scale_factor",0.9996],)"
      R"(PARAMETER["false_easting",500000],PARAMETER["false_northing",{}],{},)"
      R"(AXIS["Easting",EAST],AXIS["Northing",NORTH],AUTHORITY["EPSG","{}"]])",
      name_of(grid), kWgs84, 6 * grid.zone() - 183, north ? 0 : 10'000'000, kMetre, grid.epsg());
}

std::string local_wkt_named(const std::string& name) {
  return fmt::format(
      R"(LOCAL_CS["{0}",LOCAL_DATUM["{0}",0],{1},AXIS["East",EAST],AXIS["North",NORTH],AXIS["Up",UP]])",
      name, kMetre);
}

}  // namespace

std::string name_of(const geodesy::MapGrid& grid) {
  if (grid.zone() == 0) {
    return fmt::format("WGS 84 / UPS {} (E,N)", grid.is_north() ? "North" : "South");
  }
  return fmt::format("WGS 84 / UTM zone {}{}", grid.zone(), grid.is_north() ? 'N' : 'S');
}

std::string grid_wkt(const geodesy::MapGrid& grid) {
  return fmt::format(
      R"(COMPD_CS["{} + height above the ellipsoid",{},VERT_CS["WGS 84 ellipsoidal height",)"
      R"(VERT_DATUM["WGS 84 ellipsoid",2002],{},AXIS["Ellipsoidal height",UP]]])",
      name_of(grid), projected_wkt(grid), kMetre);
}

std::string local_wkt(const geodesy::Geodetic& origin) {
  return local_wkt_named(
      fmt::format("east, north, up at {:.9f} deg N, {:.9f} deg E, {:.3f} m above WGS 84",
                  origin.latitude_deg, origin.longitude_deg, origin.altitude_m));
}

std::string local_wkt() { return local_wkt_named("map frame, tied to no place on earth"); }

}  // namespace traverse::exports
