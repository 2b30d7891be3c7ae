#include "traverse/mapping/map_origin.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"

namespace traverse::mapping {

void write_map_origin(const std::filesystem::path& file, const geodesy::Geodetic& origin) {
  const nlohmann::ordered_json json{{"frame", "ENU"},
                                    {"datum", "WGS84"},
                                    {"latitude_deg", origin.latitude_deg},
                                    {"longitude_deg", origin.longitude_deg},
                                    {"altitude_m", origin.altitude_m}};
  files::write_text(file, json.dump(1) + "\n");
}

geodesy::Geodetic read_map_origin(const std::filesystem::path& file) {
  try {
    const auto json = nlohmann::json::parse(files::read_text(file));
    geodesy::Geodetic origin;
    origin.latitude_deg = json.at("latitude_deg");
    origin.longitude_deg = json.at("longitude_deg");
    origin.altitude_m = json.at("altitude_m");
    return origin;
  } catch (const nlohmann::json::exception& error) {
    throw files::InputError(file, files::Place::whole_file(),
                            "latitude_deg, longitude_deg and altitude_m as JSON", error.what());
  }
}

}  // namespace traverse::mapping
