#include "nmea.hpp"

#include <charconv>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "traverse/sensors/gga_quality.hpp"

namespace traverse::packets {

namespace {

std::optional<double> number_of(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

std::optional<int> digit_of(std::string_view text) {
  if (text.size() != 1 || text[0] < '0' || text[0] > '9') return std::nullopt;
  return text[0] - '0';
}

std::string_view up_to_checksum(std::string_view sentence) {
  return sentence.substr(0, sentence.find('*'));
}

std::vector<std::string_view> fields_of(std::string_view sentence) {
  std::vector<std::string_view> fields;
  for (;;) {
    const auto comma = sentence.find(',');
    fields.push_back(sentence.substr(0, comma));
    if (comma == std::string_view::npos) return fields;
    sentence.remove_prefix(comma + 1);
  }
}

/// "hhmmss.ss"
std::optional<double> seconds_of_day(std::string_view text) {
  const auto value = number_of(text);
  if (!value || *value < 0 || *value >= 240000) return std::nullopt;
  const double hours = std::floor(*value / 10000);
  const double minutes = std::floor((*value - hours * 10000) / 100);
  const double seconds = *value - hours * 10000 - minutes * 100;
  if (minutes >= 60 || seconds >= 61) return std::nullopt;
  return (hours * 60 + minutes) * 60 + seconds;
}

/// "ddmm.mmmm" or "dddmm.mmmm" and the letter of the hemisphere.
std::optional<double> angle_deg(std::string_view text, std::string_view hemisphere, double most) {
  const auto value = number_of(text);
  if (!value || *value < 0 || hemisphere.size() != 1) return std::nullopt;
  const double degrees = std::floor(*value / 100);
  const double angle = degrees + (*value - degrees * 100) / 60;
  if (angle > most) return std::nullopt;
  const char letter = hemisphere[0];
  if (letter == 'S' || letter == 'W') return -angle;
  if (letter == 'N' || letter == 'E') return angle;
  return std::nullopt;
}

/// "ddmmyy", of this century.
std::optional<std::int64_t> day_of(std::string_view text) {
  const auto value = number_of(text);
  if (!value || text.size() != 6) return std::nullopt;
  const auto digits = static_cast<int>(*value);
  const std::chrono::year_month_day day{
      std::chrono::year(2000 + digits % 100),
      std::chrono::month(static_cast<unsigned>(digits / 100 % 100)),
      std::chrono::day(static_cast<unsigned>(digits / 10000))};
  if (!day.ok()) return std::nullopt;
  return std::chrono::sys_days(day).time_since_epoch().count();
}

}  // namespace

bool has_nmea_checksum(std::string_view sentence) {
  const auto star = sentence.find('*');
  if (sentence.empty() || sentence[0] != '$' || star == std::string_view::npos ||
      sentence.size() < star + 3) {
    return false;
  }
  unsigned stated = 0;
  const char* digits = sentence.data() + star + 1;
  if (std::from_chars(digits, digits + 2, stated, 16).ptr != digits + 2) return false;
  unsigned sum = 0;
  for (const char c : sentence.substr(1, star - 1)) sum ^= static_cast<unsigned char>(c);
  return sum == stated;
}

std::optional<NmeaFix> parse_nmea_fix(std::string_view sentence) {
  if (!has_nmea_checksum(sentence)) return std::nullopt;
  const auto fields = fields_of(up_to_checksum(sentence));
  if (fields[0].size() != 6) return std::nullopt;
  const bool is_rmc = fields[0].ends_with("RMC");
  if (!is_rmc && !fields[0].ends_with("GGA")) return std::nullopt;
  if (fields.size() < (is_rmc ? 10U : 12U)) return std::nullopt;
  const std::optional<int> quality = is_rmc ? std::nullopt : digit_of(fields[6]);
  const bool is_measured = is_rmc ? fields[2] == "A" : quality && sensors::is_gga_fix(*quality);
  if (!is_measured) return std::nullopt;
  const std::size_t place = is_rmc ? 3 : 2;
  const auto time = seconds_of_day(fields[1]);
  const auto latitude = angle_deg(fields[place], fields[place + 1], 90);
  const auto longitude = angle_deg(fields[place + 2], fields[place + 3], 180);
  if (!time || !latitude || !longitude) return std::nullopt;
  NmeaFix fix;
  fix.seconds_of_day = *time;
  fix.latitude_deg = *latitude;
  fix.longitude_deg = *longitude;
  if (is_rmc) {
    fix.day = day_of(fields[9]);
  } else if (const auto above_sea = number_of(fields[9])) {
    fix.altitude_m = *above_sea + number_of(fields[11]).value_or(0);
  }
  if (quality) fix.covariance_enu = sensors::covariance_of_gga_quality(*quality);
  return fix;
}

}  // namespace traverse::packets
