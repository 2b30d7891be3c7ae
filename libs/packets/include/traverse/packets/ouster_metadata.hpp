#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace traverse::packets {

/// How a pixel is packed; the names are Ouster's.
enum class OusterProfile {
  kLegacy,           ///< LEGACY: 12 bytes, columns with a footer, no header
  kSingle,           ///< RNG19_RFL8_SIG16_NIR16
  kDual,             ///< RNG19_RFL8_SIG16_NIR16_DUAL
  kLowBandwidth,     ///< RNG15_RFL8_NIR8
  kDualLowBandwidth  ///< RNG15_RFL8_NIR8_DUAL, FUSA_RNG15_RFL8_NIR8_DUAL
};

/// "RNG15_RFL8_NIR8"
std::string_view name_of(OusterProfile profile);

/// What an Ouster says of itself, from the metadata that its programs keep beside a recording.
struct OusterMetadata {
  std::string product;         ///< "OS-1-128"
  std::string lidar_mode;      ///< "1024x10"
  std::size_t columns = 1024;  ///< a turn
  std::size_t columns_per_packet = 16;
  OusterProfile profile = OusterProfile::kLegacy;
  std::vector<double> altitude_deg;  ///< of the beams, the highest first
  std::vector<double> azimuth_deg;   ///< of the beams, clockwise from above
  double origin_to_beam_mm = 0;      ///< from the lidar's axis to where beams begin
  double beam_height_mm = 0;         ///< of that above the lidar's origin
  /// Rows of 4; translations in millimetres. The sensor frame has x where the plug is not.
  std::array<double, 16> lidar_to_sensor{-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 36.18, 0, 0, 0, 1};
  std::array<double, 16> imu_to_sensor{1, 0, 0, 6.253, 0, 1, 0, -11.775,
                                       0, 0, 1, 7.645, 0, 0, 0, 1};

  std::size_t rows() const { return altitude_deg.size(); }
  double turns_per_second() const;  ///< by the lidar mode; 10 if it does not say
};

/// Whether the text of a JSON file looks like such metadata.
bool is_ouster_metadata(std::string_view json);

/// Reads metadata, flat (firmware 1.12 to 2.5) or nested (sensor_info, lidar_data_format,
/// beam_intrinsics ...). Transforms that old firmware did not tell are those of its hardware.
/// \param file for messages
/// \throws files::InputError naming the key that is missing or wrong
OusterMetadata parse_ouster_metadata(std::string_view json, const std::filesystem::path& file);
OusterMetadata load_ouster_metadata(const std::filesystem::path& file);

}  // namespace traverse::packets
