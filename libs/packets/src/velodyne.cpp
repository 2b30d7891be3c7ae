#include "traverse/packets/velodyne.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "azimuth_table.hpp"
#include "byte_fields.hpp"
#include "velodyne_block.hpp"

namespace traverse::packets {

namespace {

constexpr std::size_t kBlocks = 12;
constexpr std::size_t kReturns = kVelodyneReturns;
constexpr std::size_t kReturnBytes = kVelodyneReturnBytes;
constexpr std::size_t kBlockBytes = 4 + kReturns * kReturnBytes;
constexpr std::size_t kTimeAt = kBlocks * kBlockBytes;
constexpr std::size_t kModeAt = kTimeAt + 4;
constexpr std::size_t kModelAt = kTimeAt + 5;
constexpr std::uint8_t kDual = 0x39;
constexpr std::array<std::uint32_t, 4> kBanks{0xEEFF, 0xDDFF, 0xCCFF, 0xBBFF};
constexpr int kTurn = 36000;  // of azimuths' units
constexpr double kUnit = std::numbers::pi / (kTurn / 2);
constexpr std::uint32_t kHour_us = 3600000000U;

/// How the firings of a model stand in its packets and follow each other.
struct Timing {
  std::size_t lasers;
  std::size_t blocks;       ///< that share a firing, of one return
  double group_us;          ///< from one of these to the next
  double distance_m;        ///< that a 1 means
  std::size_t firings = 1;  ///< of all lasers in a block
};

Timing timing_of(VelodyneModel model) {
  switch (model) {
    case VelodyneModel::kVlp16:
    case VelodyneModel::kVlp16HiRes:
      return {16, 1, 2 * 55.296, 0.002, 2};
    case VelodyneModel::kVlp32c:
      return {32, 1, 55.296, 0.004};
    case VelodyneModel::kHdl32e:
      return {32, 1, 46.08, 0.002};
    case VelodyneModel::kHdl64e:
      return {64, 2, 48, 0.002};
    case VelodyneModel::kVls128:
      return {128, 4, 53.3, 0.004};
  }
  return {};
}

/// When beam `k` of a group fires, after the packet's time.
double beam_delay_us(VelodyneModel model, std::size_t k) {
  const auto laser = static_cast<double>(k);
  switch (model) {
    case VelodyneModel::kVlp16:
    case VelodyneModel::kVlp16HiRes:
      return 55.296 * static_cast<double>(k / 16) + 2.304 * static_cast<double>(k % 16);
    case VelodyneModel::kVlp32c:
      return 2.304 * static_cast<double>(k / 2);
    case VelodyneModel::kHdl32e:
      return 1.152 * laser;
    case VelodyneModel::kHdl64e:
      return 0;  // its corrections of azimuth hold the turn meanwhile
    case VelodyneModel::kVls128:
      // After eight groups of eight lasers one of their times passes without any; the packet's time
      // is 8.7 us after the first of them.
      return 2.665 * static_cast<double>(k / 8 + k / 64) - 8.7;
  }
  return 0;
}

const std::uint8_t* block_at(VelodynePacket packet, std::size_t block) {
  return packet.data() + block * kBlockBytes;
}

const std::uint8_t* return_at(VelodynePacket packet, std::size_t block, std::size_t k) {
  return block_at(packet, block) + 4 + k * kReturnBytes;
}

int azimuth_at(VelodynePacket packet, std::size_t block) {
  return static_cast<int>(u16_at(block_at(packet, block) + 2)) % kTurn;
}

/// 0 to 3, by the block's flag; 4 if it has none.
std::size_t bank_of(VelodynePacket packet, std::size_t block) {
  const std::uint32_t flag = u16_at(block_at(packet, block));
  return static_cast<std::size_t>(std::find(kBanks.begin(), kBanks.end(), flag) - kBanks.begin());
}

/// In packets of an HDL-64E a byte of its status stands there.
bool is_dual(VelodynePacket packet, VelodyneModel model) {
  return model != VelodyneModel::kHdl64e && packet[kModeAt] == kDual;
}

/// A firing of a VLS-128 with two returns takes eight blocks; the last four hold nothing.
std::size_t used_blocks(VelodynePacket packet, VelodyneModel model) {
  return model == VelodyneModel::kVls128 && is_dual(packet, model) ? 8 : kBlocks;
}

bool has_banks(VelodynePacket packet, std::size_t blocks) {
  for (std::size_t block = 0; block < blocks; ++block) {
    if (bank_of(packet, block) == kBanks.size()) return false;
  }
  return true;
}

/// The last and the strongest return of one firing are often one and the same.
bool is_repeated(VelodynePacket packet, bool dual, std::size_t block, std::size_t k) {
  return dual && block % 2 == 1 &&
         u16_at(return_at(packet, block, k)) == u16_at(return_at(packet, block - 1, k));
}

/// By how many units the head turns from one block to the one `apart` blocks later. The median:
/// between two blocks may be a sector in which nothing is sent.
double units_turned(VelodynePacket packet, std::size_t apart) {
  std::array<int, kBlocks> turned{};
  const std::size_t count = kBlocks - apart;
  for (std::size_t i = 0; i < count; ++i) {
    turned[i] = (azimuth_at(packet, i + apart) - azimuth_at(packet, i) + kTurn) % kTurn;
  }
  auto sorted = turned;
  std::nth_element(sorted.begin(), sorted.begin() + count / 2, sorted.begin() + count);
  const int usual = sorted[count / 2];
  // Azimuths are whole units: the mean of those that are usual knows more than one of them.
  double sum = 0;
  double n = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (std::abs(turned[i] - usual) > 2) continue;
    sum += turned[i];
    ++n;
  }
  return sum / n;
}

std::size_t apart_of(VelodynePacket packet, VelodyneModel model) {
  return timing_of(model).blocks * (is_dual(packet, model) ? 2 : 1);
}

void resize(sensors::LidarScan& scan, std::size_t points) {
  for (std::vector<float>* column : {&scan.x, &scan.y, &scan.z, &scan.intensity, &scan.time}) {
    column->resize(points);
  }
  scan.ring.resize(points);
}

}  // namespace

std::string_view name_of(VelodyneModel model) {
  switch (model) {
    case VelodyneModel::kVlp16:
      return "VLP-16";
    case VelodyneModel::kVlp16HiRes:
      return "Puck Hi-Res";
    case VelodyneModel::kVlp32c:
      return "VLP-32C";
    case VelodyneModel::kHdl32e:
      return "HDL-32E";
    case VelodyneModel::kHdl64e:
      return "HDL-64E";
    case VelodyneModel::kVls128:
      return "VLS-128";
  }
  return "Velodyne";
}

std::uint32_t velodyne_microseconds(VelodynePacket packet) {
  return u32_at(packet.data() + kTimeAt);
}

bool is_velodyne_data(VelodynePacket packet) {
  if (!has_banks(packet, 8)) return false;
  return has_banks(packet, kBlocks) ||
         (velodyne_model(packet) == VelodyneModel::kVls128 && packet[kModeAt] == kDual);
}

std::optional<VelodyneModel> velodyne_model(VelodynePacket packet) {
  if (!has_banks(packet, 8)) return std::nullopt;
  std::size_t highest = 0;
  for (std::size_t block = 0; block < 8; ++block) {
    highest = std::max(highest, bank_of(packet, block));
  }
  // What stands in the place of the factory byte in packets of an HDL-64E may be any.
  if (highest == 1) return VelodyneModel::kHdl64e;
  if (highest > 1) return VelodyneModel::kVls128;
  switch (packet[kModelAt]) {
    case 0x21:
      return VelodyneModel::kHdl32e;
    case 0x22:
      return VelodyneModel::kVlp16;
    case 0x24:
      return VelodyneModel::kVlp16HiRes;
    case 0x28:
      return VelodyneModel::kVlp32c;
    default:
      return std::nullopt;
  }
}

std::size_t velodyne_returns(VelodynePacket packet, VelodyneModel model) {
  std::size_t count = 0;
  const bool dual = is_dual(packet, model);
  for (std::size_t block = 0; block < used_blocks(packet, model); ++block) {
    for (std::size_t k = 0; k < kReturns; ++k) {
      count += u16_at(return_at(packet, block, k)) != 0 && !is_repeated(packet, dual, block, k);
    }
  }
  return count;
}

VelodyneDecoder::VelodyneDecoder(VelodyneModel model, const std::vector<VelodyneLaser>& lasers)
    : model_(model) {
  const Timing timing = timing_of(model_);
  if (lasers.size() != timing.lasers) {
    throw std::invalid_argument("a calibration of another number of lasers than the model has");
  }
  for (std::size_t group = 0; group < group_begin_ns_.size(); ++group) {
    group_begin_ns_[group] = static_cast<std::int32_t>(std::lround(
        (static_cast<double>(group) * timing.group_us + beam_delay_us(model_, 0)) * 1e3));
  }
  beam_count_ = timing.lasers * timing.firings;
  for (std::size_t k = 0; k < beam_count_; ++k) {
    const std::size_t laser = k % timing.lasers;
    const VelodyneLaser& optics = lasers[laser];
    beams_.sin_elevation[k] = static_cast<float>(std::sin(optics.elevation));
    beams_.cos_elevation[k] = static_cast<float>(std::cos(optics.elevation));
    beams_.sin_azimuth[k] = static_cast<float>(std::sin(-optics.azimuth_correction));
    beams_.cos_azimuth[k] = static_cast<float>(std::cos(-optics.azimuth_correction));
    beams_.distance_m[k] = static_cast<float>(optics.distance_correction_m);
    beams_.vertical_m[k] = static_cast<float>(optics.vertical_offset_m);
    beams_.horizontal_m[k] = static_cast<float>(optics.horizontal_offset_m);
    beams_.delay_us[k] = static_cast<float>(beam_delay_us(model_, k));
    beams_.ring[k] = static_cast<std::uint16_t>(laser);
    has_offsets_ = has_offsets_ || optics.vertical_offset_m != 0 || optics.horizontal_offset_m != 0;
  }
}

bool VelodyneDecoder::read_outline(VelodynePacket packet, PacketOutline& outline) const {
  outline.is_dual = is_dual(packet, model_);
  if (!has_banks(packet, used_blocks(packet, model_))) return false;
  const std::size_t apart = apart_of(packet, model_);
  const Timing timing = timing_of(model_);
  outline.sensor_ns = static_cast<std::int64_t>(velodyne_microseconds(packet)) * 1000;
  outline.groups = used_blocks(packet, model_) / apart;
  outline.has_frame = false;
  for (std::size_t group = 0; group < outline.groups; ++group) {
    outline.azimuth[group] = azimuth_at(packet, group * apart);
    outline.begin_ns[group] = group_begin_ns_[group];
  }
  outline.rate = outline.groups > 1 ? units_turned(packet, apart) * kUnit / timing.group_us : 0;
  return true;
}

PacketKind VelodyneDecoder::outline(Bytes packet, PacketOutline& outline) {
  if (packet.size() != kVelodynePacketBytes) return PacketKind::kOther;
  const VelodynePacket bytes(packet.data(), kVelodynePacketBytes);
  if (bank_of(bytes, 0) == kBanks.size()) return PacketKind::kOther;
  if (!read_outline(bytes, outline)) return PacketKind::kDamaged;
  if (outline.groups == 1) {  // how fast it turns, one packet does not tell
    const Last here{outline.sensor_ns / 1000, outline.azimuth[0]};
    const std::int64_t us = last_ ? here.us - last_->us : 0;
    if (us > 0 && us < 1000) {
      const int units = (here.azimuth - last_->azimuth + kTurn) % kTurn;
      outline.rate = units * kUnit / static_cast<double>(us);
    }
    last_ = here;
  }
  return PacketKind::kData;
}

void VelodyneDecoder::turn_beams(double rate, TurnedBeams& turned) const {
  const auto turn = static_cast<float>(rate);
  for (std::size_t k = 0; k < beam_count_; ++k) {
    // A block's azimuth is that of its first firing. At most 0.8 degrees at 20 turns a second: what
    // the series leaves out is below 1e-9.
    const float d = turn * (beams_.delay_us[k] - beams_.delay_us[0]);
    const float sin = d * (1 - d * d * (1.0F / 6));
    const float cos = 1 - d * d * (0.5F - d * d * (1.0F / 24));
    turned.sin_azimuth[k] = beams_.sin_azimuth[k] * cos + beams_.cos_azimuth[k] * sin;
    turned.cos_azimuth[k] = beams_.cos_azimuth[k] * cos - beams_.sin_azimuth[k] * sin;
  }
}

ReturnCounts VelodyneDecoder::append(Bytes packet, const PacketOutline& outline, std::size_t first,
                                     std::size_t last, double zero_s,
                                     sensors::LidarScan& scan) const {
  const VelodynePacket bytes(packet.data(), kVelodynePacketBytes);
  const Timing timing = timing_of(model_);
  const std::size_t apart = apart_of(bytes, model_);
  const auto unit_m = static_cast<float>(timing.distance_m);
  const AzimuthTable& azimuths = azimuth_table();
  TurnedBeams turned;
  turn_beams(outline.rate, turned);

  const std::size_t begin = first * apart;
  const std::size_t end = last * apart;
  const std::size_t before = scan.size();
  const std::size_t room = before + (end - begin) * kReturns + kBlockSpill;
  resize(scan, room);
  ReturnCounts counts;
  for (std::size_t block = begin; block < end; ++block) {
    const std::size_t bank = timing.blocks == 1 ? 0 : bank_of(bytes, block);
    const std::size_t beam = bank * kReturns;
    if (beam + kReturns > beam_count_) continue;
    const auto begin_s =
        static_cast<float>(zero_s + static_cast<double>(block / apart) * timing.group_us * 1e-6);
    const auto [sin, cos] = azimuths.entries[static_cast<std::size_t>(azimuth_at(bytes, block))];
    const BlockBeams beams{&turned.sin_azimuth[beam],
                           &turned.cos_azimuth[beam],
                           &beams_.sin_elevation[beam],
                           &beams_.cos_elevation[beam],
                           &beams_.distance_m[beam],
                           &beams_.delay_us[beam],
                           &beams_.ring[beam],
                           has_offsets_ ? &beams_.horizontal_m[beam] : nullptr,
                           has_offsets_ ? &beams_.vertical_m[beam] : nullptr};
    const bool is_second = outline.is_dual && block % 2 == 1;
    const std::size_t at = before + counts.points;
    counts += decode_block({sin, cos, unit_m, begin_s}, beams, return_at(bytes, block, 0),
                           is_second ? return_at(bytes, block - 1, 0) : nullptr,
                           {&scan.x[at], &scan.y[at], &scan.z[at], &scan.intensity[at],
                            &scan.time[at], &scan.ring[at]});
  }
  resize(scan, before + counts.points);
  return counts;
}

std::size_t VelodyneDecoder::append(VelodynePacket packet, std::uint32_t zero_us,
                                    sensors::LidarScan& scan) const {
  PacketOutline outline;
  if (!read_outline(packet, outline)) return 0;
  std::int64_t packet_us =
      static_cast<std::int64_t>(velodyne_microseconds(packet)) - static_cast<std::int64_t>(zero_us);
  if (packet_us > kHour_us / 2) packet_us -= kHour_us;
  if (packet_us < -static_cast<std::int64_t>(kHour_us / 2)) packet_us += kHour_us;
  return append(packet, outline, 0, outline.groups, static_cast<double>(packet_us) * 1e-6, scan)
      .points;
}

}  // namespace traverse::packets
