#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include <Eigen/Core>

namespace traverse::packets {

/// A place that an NMEA 0183 sentence tells.
struct NmeaFix {
  double seconds_of_day = 0;        ///< UTC
  std::optional<std::int64_t> day;  ///< since 1970-01-01; RMC tells it
  double latitude_deg = 0;
  double longitude_deg = 0;
  std::optional<double> altitude_m;               ///< above the ellipsoid; GGA tells it
  std::optional<Eigen::Matrix3d> covariance_enu;  ///< m^2, by the quality code of a GGA
};

/// The fix of an RMC or GGA sentence of any talker, with or without a line's end.
/// \returns nothing if it is another sentence, its checksum is wrong, or the place was not measured
std::optional<NmeaFix> parse_nmea_fix(std::string_view sentence);

/// Whether the checksum after the asterisk is that of the sentence.
bool has_nmea_checksum(std::string_view sentence);

}  // namespace traverse::packets
