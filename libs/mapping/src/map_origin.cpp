#include "traverse/mapping/map_origin.hpp"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/json_document.hpp"

namespace traverse::mapping {

namespace {

constexpr double kHighest_m = 1e6;  // above what is called space

}  // namespace

void write_map_origin(const std::filesystem::path& file, const geodesy::Geodetic& origin) {
  const nlohmann::ordered_json json{{"frame", "ENU"},
                                    {"datum", "WGS84"},
                                    {"latitude_deg", origin.latitude_deg},
                                    {"longitude_deg", origin.longitude_deg},
                                    {"altitude_m", origin.altitude_m}};
  files::write_text(file, json.dump(1) + "\n");
}

geodesy::Geodetic read_map_origin(const std::filesystem::path& file) {
  const auto document = files::JsonDocument::read(file);
  const files::JsonValue json = document.root();
  const auto within = [&](const char* key, double most) {
    const double value = json[key].number();
    if (!(std::abs(value) <= most)) {
      throw json[key].error(fmt::format("a number from {} to {}", -most, most));
    }
    return value;
  };
  geodesy::Geodetic origin;
  origin.latitude_deg = within("latitude_deg", 90);
  origin.longitude_deg = within("longitude_deg", 360);  // receivers count from -180 or from 0
  origin.altitude_m = within("altitude_m", kHighest_m);
  return origin;
}

}  // namespace traverse::mapping
