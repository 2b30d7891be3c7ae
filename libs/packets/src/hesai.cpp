#include "hesai.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "azimuth_table.hpp"
#include "byte_fields.hpp"
#include "hesai_tables.hpp"
#include "point_rows.hpp"

namespace traverse::packets {

namespace {

/// Where things stand in a packet; the tail's fields are counted from its beginning.
struct Layout {
  std::size_t lasers;
  std::size_t blocks;
  std::size_t header_bytes;
  std::size_t block_head_bytes;  ///< before the returns of a block; the azimuth ends it
  std::size_t return_bytes;
  std::size_t tail_bytes;
  std::size_t mode_at;
  std::size_t date_at;  ///< year, month, day, hour, minute, second
  std::size_t us_at;
  double base_us;    ///< of the last block after the packet's time, or of the first
  double period_us;  ///< from one firing of all to the next
  bool counts_from_last = true;

  std::size_t block_bytes() const { return block_head_bytes + lasers * return_bytes; }
  std::size_t body_end() const { return header_bytes + blocks * block_bytes(); }
};

Layout layout_of(HesaiModel model) {
  switch (model) {
    case HesaiModel::kPandar40p:
      return {40, 10, 0, 4, 3, 22, 14, 16, 10, -28.58, 55.56};
    case HesaiModel::kPandar64:
      return {64, 6, 8, 2, 3, 22, 14, 16, 10, -42.58, 55.56};
    case HesaiModel::kXt16:
      return {16, 8, 12, 2, 4, 24, 10, 13, 19, 5.632, 50};
    case HesaiModel::kXt32:
      return {32, 8, 12, 2, 4, 24, 10, 13, 19, 5.632, 50};
    case HesaiModel::kQt64:
      return {64, 4, 12, 2, 4, 24, 16, 18, 12, 25.71, 500.0 / 3, false};
    case HesaiModel::kPandar128:
      return {128, 2, 12, 2, 3, 26, 12, 15, 21, 3.148, 2 * 27.778};
  }
  return {};
}

constexpr std::size_t kAzimuthStateAt = 9;  // in the tail of a Pandar128
constexpr std::size_t kOperationAt = 11;
constexpr std::uint8_t kHighResolution = 0;
constexpr std::uint8_t kHasFunctionalSafety = 4;
constexpr std::size_t kChecksumBytes = 4;
constexpr std::size_t kFunctionalSafetyBytes = 17;

/// Where the tail begins.
std::size_t tail_at(HesaiModel model, Bytes packet) {
  const std::size_t end = layout_of(model).body_end();
  if (model != HesaiModel::kPandar128) return end;
  const bool has_safety = (packet[11] & kHasFunctionalSafety) != 0;
  return end + kChecksumBytes + (has_safety ? kFunctionalSafetyBytes : 0);
}

bool has_size_of(HesaiModel model, Bytes packet) {
  const Layout layout = layout_of(model);
  return packet.size() > 12 && packet.size() >= layout.body_end() + layout.tail_bytes &&
         packet.size() >= tail_at(model, packet) + layout.tail_bytes;
}

/// Millimetres that a 1 in a distance means.
unsigned unit_mm(HesaiModel model, Bytes packet) {
  switch (model) {
    case HesaiModel::kPandar40p:
      return 4;
    case HesaiModel::kPandar64:
      return packet[5];
    default:
      return packet[9];
  }
}

bool sends_two_returns(std::uint8_t mode) { return mode >= 0x39 && mode <= 0x3C; }

/// Modes of one return, or of two. Three returns, which only other models send, are none.
bool is_return_mode(std::uint8_t mode) {
  return sends_two_returns(mode) || (mode >= 0x33 && mode <= 0x38) || mode == 0x3E;
}

std::int64_t nanoseconds_of(const std::uint8_t* date, std::uint32_t us) {
  // Years since 1900, of early firmware since 2000.
  const int year = date[0] + (date[0] >= 100 ? 1900 : 2000);
  const std::chrono::year_month_day day{std::chrono::year(year), std::chrono::month(date[1]),
                                        std::chrono::day(date[2])};
  const std::int64_t days = day.ok() ? std::chrono::sys_days(day).time_since_epoch().count() : 0;
  const std::int64_t seconds = ((days * 24 + date[3]) * 60 + date[4]) * 60 + date[5];
  return seconds * 1'000'000'000 + static_cast<std::int64_t>(us) * 1000;
}

std::size_t state_of(const std::uint8_t* tail, std::size_t block) {
  return u16_at(tail + kAzimuthStateAt) >> (14 - 2 * block) & 3;
}

}  // namespace

std::string_view name_of(HesaiModel model) {
  switch (model) {
    case HesaiModel::kPandar40p:
      return "Pandar40P";
    case HesaiModel::kPandar64:
      return "Pandar64";
    case HesaiModel::kXt16:
      return "PandarXT-16";
    case HesaiModel::kXt32:
      return "PandarXT-32";
    case HesaiModel::kQt64:
      return "PandarQT64";
    case HesaiModel::kPandar128:
      return "Pandar128";
  }
  return "Hesai";
}

std::optional<HesaiModel> hesai_model(Bytes packet) {
  if (packet.size() < 500) return std::nullopt;
  if (packet[0] == 0xFF && packet[1] == 0xEE) {
    const bool is_40p = (packet.size() == 1262 || packet.size() == 1266) && packet[124] == 0xFF &&
                        packet[125] == 0xEE;
    return is_40p ? std::optional(HesaiModel::kPandar40p) : std::nullopt;
  }
  if (packet[0] != 0xEE || packet[1] != 0xFF) return std::nullopt;
  const auto fits = [packet](HesaiModel model) {
    return has_size_of(model, packet) ? std::optional(model) : std::nullopt;
  };
  if (packet[2] == 64 && packet[3] == 6) return fits(HesaiModel::kPandar64);
  const int lasers = packet[6];
  const int blocks = packet[7];
  if (lasers == 64 && blocks == 4) return fits(HesaiModel::kQt64);
  if (lasers == 32 && blocks == 8) return fits(HesaiModel::kXt32);
  if (lasers == 16 && blocks == 8) return fits(HesaiModel::kXt16);
  // Larger packets of 128 lasers are of the OT128, whose returns take four bytes.
  if (lasers == 128 && blocks == 2 && packet.size() < 1000) return fits(HesaiModel::kPandar128);
  return std::nullopt;
}

HesaiDecoder::HesaiDecoder(HesaiModel model, const std::vector<HesaiLaser>& lasers)
    : model_(model) {
  const Layout layout = layout_of(model_);
  if (lasers.size() != layout.lasers) {
    throw std::invalid_argument("a calibration of another number of lasers than the model has");
  }
  constexpr double kDegree = std::numbers::pi / 180;
  for (std::size_t i = 0; i < lasers.size(); ++i) {
    sin_elevation_[i] = static_cast<float>(std::sin(lasers[i].elevation_deg * kDegree));
    cos_elevation_[i] = static_cast<float>(std::cos(lasers[i].elevation_deg * kDegree));
    sin_azimuth_[i] = static_cast<float>(std::sin(lasers[i].azimuth_deg * kDegree));
    cos_azimuth_[i] = static_cast<float>(std::cos(lasers[i].azimuth_deg * kDegree));
  }
  const bool has_states = model_ == HesaiModel::kPandar128;
  delays_.resize(has_states ? 8 : 1);
  for (std::size_t state = 0; state < delays_.size(); ++state) {
    for (std::size_t i = 0; i < lasers.size(); ++i) {
      const auto at = [&](bool near) {
        return static_cast<float>(
            has_states ? std::max(pandar128_firing_us(i, state % 4, state >= 4, near), 0.0)
                       : hesai_firing_us(model_, i));
      };
      delays_[state].far_us[i] = at(false);
      delays_[state].near_us[i] = at(true);
    }
  }
}

PacketKind HesaiDecoder::outline(Bytes packet, PacketOutline& outline) {
  if (hesai_model(packet) != model_) return PacketKind::kOther;
  const Layout layout = layout_of(model_);
  const std::uint8_t* tail = packet.data() + tail_at(model_, packet);
  const std::uint8_t mode = tail[layout.mode_at];
  if (!is_return_mode(mode) || unit_mm(model_, packet) == 0) return PacketKind::kDamaged;
  outline.is_dual = sends_two_returns(mode) || mode == 0x3E;
  outline.has_frame = false;
  outline.rate = 0;  // a block's azimuth holds for all of its firings
  const std::size_t alike = outline.is_dual ? 2 : 1;
  outline.groups = layout.blocks / alike;
  outline.sensor_ns = nanoseconds_of(tail + layout.date_at, u32_at(tail + layout.us_at));
  const Delays& delays = delays_.front();
  const double first_us =
      *std::min_element(delays.far_us.begin(), delays.far_us.begin() + layout.lasers);
  const double period_us = model_ == HesaiModel::kPandar128 && tail[kOperationAt] == kHighResolution
                               ? layout.period_us / 2
                               : layout.period_us;
  outline.period_us = period_us;
  for (std::size_t group = 0; group < outline.groups; ++group) {
    const std::uint8_t* block =
        packet.data() + layout.header_bytes + group * alike * layout.block_bytes();
    const std::uint32_t azimuth = u16_at(block + layout.block_head_bytes - 2);
    if (azimuth >= PacketOutline::kTurn) return PacketKind::kDamaged;
    if (layout.block_head_bytes == 4 && u16_at(block) != 0xEEFF) return PacketKind::kDamaged;
    outline.azimuth[group] = static_cast<std::int32_t>(azimuth);
    const double periods = layout.counts_from_last ? static_cast<double>(group) -
                                                         static_cast<double>(outline.groups - 1)
                                                   : static_cast<double>(group);
    outline.begin_ns[group] = static_cast<std::int32_t>(
        std::lround((layout.base_us + periods * period_us + first_us) * 1e3));
  }
  return PacketKind::kData;
}

ReturnCounts HesaiDecoder::append(Bytes packet, const PacketOutline& outline, std::size_t first,
                                  std::size_t last, double zero_s, sensors::LidarScan& scan) const {
  const Layout layout = layout_of(model_);
  const std::uint8_t* tail = packet.data() + tail_at(model_, packet);
  const std::size_t alike = outline.is_dual ? 2 : 1;
  const bool has_states = delays_.size() > 1;
  const bool is_high = has_states && tail[kOperationAt] == kHighResolution;
  const float unit_m = static_cast<float>(unit_mm(model_, packet)) * 1e-3F;
  const AzimuthTable& azimuths = azimuth_table();

  ReturnCounts counts;
  PointRows rows(scan);
  for (std::size_t block = first * alike; block < last * alike; ++block) {
    const std::uint8_t* at = packet.data() + layout.header_bytes + block * layout.block_bytes();
    const std::uint8_t* returns = at + layout.block_head_bytes;
    const auto [sin, cos] =
        azimuths.entries[u16_at(returns - 2) % static_cast<std::uint32_t>(PacketOutline::kTurn)];
    const std::size_t group = block / alike;
    const double periods = layout.counts_from_last ? static_cast<double>(group) -
                                                         static_cast<double>(outline.groups - 1)
                                                   : static_cast<double>(group);
    const auto begin_s =
        static_cast<float>(zero_s + (layout.base_us + periods * outline.period_us) * 1e-6);
    const Delays& delays = delays_[has_states ? state_of(tail, block) + (is_high ? 4 : 0) : 0];
    const bool second = outline.is_dual && block % 2 == 1;
    rows.reserve(layout.lasers);
    std::size_t n = 0;
    for (std::size_t k = 0; k < layout.lasers; ++k) {
      const std::uint8_t* from = returns + k * layout.return_bytes;
      const std::uint32_t units = u16_at(from);
      if (units == 0) continue;
      ++counts.returns;
      if (second && units == u16_at(from - layout.block_bytes())) {
        ++counts.repeated;
        continue;
      }
      const float length = static_cast<float>(static_cast<int>(units)) * unit_m;
      const float across = length * cos_elevation_[k];
      // Azimuths are clockwise from above.
      rows.x()[n] = across * (sin * cos_azimuth_[k] + cos * sin_azimuth_[k]);
      rows.y()[n] = across * (cos * cos_azimuth_[k] - sin * sin_azimuth_[k]);
      rows.z()[n] = length * sin_elevation_[k];
      rows.intensity()[n] = static_cast<float>(static_cast<int>(from[2]));
      const bool near = has_states && length <= static_cast<float>(kPandar128Near_m);
      rows.time()[n] = begin_s + (near ? delays.near_us[k] : delays.far_us[k]) * 1e-6F;
      rows.ring()[n] = static_cast<std::uint16_t>(k);
      ++n;
    }
    counts.points += n;
    rows.take(n);
  }
  return counts;
}

}  // namespace traverse::packets
