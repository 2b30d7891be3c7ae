#include "traverse/packets/ouster_metadata.hpp"

#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "traverse/files/input_error.hpp"

namespace traverse::packets {

namespace {

using nlohmann::json;

constexpr std::array kProfileNames{
    std::pair(std::string_view("LEGACY"), OusterProfile::kLegacy),
    std::pair(std::string_view("RNG19_RFL8_SIG16_NIR16"), OusterProfile::kSingle),
    std::pair(std::string_view("RNG19_RFL8_SIG16_NIR16_DUAL"), OusterProfile::kDual),
    std::pair(std::string_view("RNG15_RFL8_NIR8"), OusterProfile::kLowBandwidth),
    std::pair(std::string_view("RNG15_RFL8_NIR8_DUAL"), OusterProfile::kDualLowBandwidth),
    std::pair(std::string_view("FUSA_RNG15_RFL8_NIR8_DUAL"), OusterProfile::kDualLowBandwidth)};

/// A key may stand at the top or in one of the groups of the nested form.
class MetadataKeys {
 public:
  MetadataKeys(const json& root, const std::filesystem::path& file) : root_(root), file_(file) {}

  const json* find(const char* key) const {
    if (root_.contains(key)) return &root_.at(key);
    for (const char* group : {"sensor_info", "beam_intrinsics", "lidar_data_format", "data_format",
                              "lidar_intrinsics", "imu_intrinsics", "config_params"}) {
      if (root_.contains(group) && root_.at(group).is_object() && root_.at(group).contains(key)) {
        return &root_.at(group).at(key);
      }
    }
    return nullptr;
  }

  std::string text(const char* key) const {
    const json* value = find(key);
    return value != nullptr && value->is_string() ? value->get<std::string>() : std::string();
  }

  std::optional<double> number(const char* key) const {
    const json* value = find(key);
    if (value == nullptr || value->is_null()) return std::nullopt;
    if (!value->is_number()) throw error(key, "a number", value->dump());
    return value->get<double>();
  }

  std::size_t count(const char* key, std::size_t otherwise, std::size_t most) const {
    const auto value = number(key);
    if (!value) return otherwise;
    if (!(*value >= 1 && *value <= static_cast<double>(most))) {
      throw error(key, fmt::format("1 to {}", most), fmt::format("{}", *value));
    }
    return static_cast<std::size_t>(*value);
  }

  std::vector<double> numbers(const char* key) const {
    const json* value = find(key);
    std::vector<double> numbers;
    if (value == nullptr || !value->is_array()) return numbers;
    for (const json& item : *value) {
      if (!item.is_number()) throw error(key, "a list of numbers", item.dump().substr(0, 40));
      numbers.push_back(item.get<double>());
    }
    return numbers;
  }

  void transform(const char* key, std::array<double, 16>& values) const {
    const auto stated = numbers(key);
    if (stated.empty()) return;
    if (stated.size() != values.size()) {
      throw error(key, "16 numbers, a matrix row by row", fmt::format("{}", stated.size()));
    }
    std::copy(stated.begin(), stated.end(), values.begin());
  }

  files::InputError error(const char* key, std::string expected, std::string found) const {
    return {file_, files::Place::whole_file(), fmt::format("{}: {}", key, expected),
            std::move(found)};
  }

 private:
  const json& root_;
  const std::filesystem::path& file_;
};

/// How far beams begin from the axis where the firmware did not tell [mm]; the last is that of the
/// first generation (ouster_core/src/sensor_info.cpp of ouster-lidar/ouster-sdk 46b7bce).
double origin_of(const std::string& product) {
  if (product.starts_with("OS-0-")) return 27.67;
  if (product.starts_with("OS-1-")) return 15.806;
  if (product.starts_with("OS-2-")) return 13.762;
  return 12.163;
}

}  // namespace

std::string_view name_of(OusterProfile profile) {
  for (const auto& [name, value] : kProfileNames) {
    if (value == profile) return name;
  }
  return "unknown";
}

double OusterMetadata::turns_per_second() const {
  const auto cross = lidar_mode.find('x');
  double hz = 0;
  if (cross == std::string::npos || std::sscanf(lidar_mode.c_str() + cross + 1, "%lf", &hz) != 1 ||
      !(hz > 0)) {
    return 10;
  }
  return hz;
}

bool is_ouster_metadata(std::string_view text) {
  return text.find("\"beam_altitude_angles\"") != std::string_view::npos &&
         text.find("\"beam_azimuth_angles\"") != std::string_view::npos;
}

OusterMetadata parse_ouster_metadata(std::string_view text, const std::filesystem::path& file) {
  const json root = json::parse(text, nullptr, false);
  if (root.is_discarded() || !root.is_object()) {
    throw files::InputError(file, files::Place::whole_file(), "an Ouster's metadata as JSON",
                            "no JSON object");
  }
  const MetadataKeys keys(root, file);
  OusterMetadata metadata;
  metadata.product = keys.text("prod_line");
  metadata.lidar_mode = keys.text("lidar_mode");
  metadata.altitude_deg = keys.numbers("beam_altitude_angles");
  metadata.azimuth_deg = keys.numbers("beam_azimuth_angles");
  constexpr std::size_t kMostRows = 512;
  if (metadata.altitude_deg.empty() || metadata.altitude_deg.size() > kMostRows) {
    throw keys.error("beam_altitude_angles", fmt::format("1 to {} angles", kMostRows),
                     fmt::format("{}", metadata.altitude_deg.size()));
  }
  if (metadata.azimuth_deg.size() != metadata.altitude_deg.size()) {
    throw keys.error("beam_azimuth_angles",
                     fmt::format("{} angles, one a beam", metadata.altitude_deg.size()),
                     fmt::format("{}", metadata.azimuth_deg.size()));
  }
  std::size_t columns = 1024;
  std::sscanf(metadata.lidar_mode.c_str(), "%zu", &columns);
  metadata.columns = keys.count("columns_per_frame", columns, 1 << 14);
  metadata.columns_per_packet = keys.count("columns_per_packet", 16, 64);
  // Firmware 1.x sends one line of pixels for each of 64 beams, of which 16 or 32 may be in use.
  const std::size_t pixels = keys.count("pixels_per_column", metadata.rows(), kMostRows);
  if (pixels != metadata.rows()) {
    throw keys.error("pixels_per_column", fmt::format("{}, one a beam", metadata.rows()),
                     fmt::format("{}", pixels));
  }
  const std::string profile = keys.text("udp_profile_lidar");
  bool is_known = profile.empty();
  for (const auto& [name, value] : kProfileNames) {
    if (name != profile) continue;
    metadata.profile = value;
    is_known = true;
  }
  if (!is_known) {
    std::string known;
    for (const auto& [name, value] : kProfileNames) known += fmt::format(" {}", name);
    throw keys.error("udp_profile_lidar", "one of" + known, profile);
  }
  metadata.origin_to_beam_mm =
      keys.number("lidar_origin_to_beam_origin_mm").value_or(origin_of(metadata.product));
  const auto beam_to_lidar = keys.numbers("beam_to_lidar_transform");
  if (beam_to_lidar.size() == 16) {
    metadata.origin_to_beam_mm = beam_to_lidar[3];
    metadata.beam_height_mm = beam_to_lidar[11];
  }
  keys.transform("lidar_to_sensor_transform", metadata.lidar_to_sensor);
  keys.transform("imu_to_sensor_transform", metadata.imu_to_sensor);
  return metadata;
}

OusterMetadata load_ouster_metadata(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    throw files::InputError(file, files::Place::whole_file(), "an Ouster's metadata as JSON",
                            "no file that can be read");
  }
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  return parse_ouster_metadata(text, file);
}

}  // namespace traverse::packets
