// Packets of a sensor that flies towards a wall, in each model's own firing order, put together to
// sweeps and deskewed. At 300 m/s a microsecond is 0.3 mm.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "traverse/packets/packet_sweeps.hpp"
#include "traverse/packets/velodyne.hpp"
#include "traverse/sensors/lidar_profile.hpp"

#include "hesai.hpp"
#include "ouster.hpp"
#include "packets/made_velodyne_packet.hpp"

namespace traverse::packets {
namespace {

using Eigen::Vector3d;
using testing::MadeVelodynePacket;

constexpr double kPerDegree = std::numbers::pi / 180;
constexpr double kWall_m = 110;
constexpr double kSpeed = 300;
constexpr double kYawRate = 0.5;
constexpr double kTurnRate_deg = 3600;  // per second
constexpr double kMost_m = 130;
constexpr std::int64_t kBegin_ns = 1'700'000'000'000'000'000;

Vector3d in_world(const Vector3d& p, double t) {
  return Eigen::AngleAxisd(kYawRate * t, Vector3d::UnitZ()) * p + Vector3d(kSpeed * t, 0, 0);
}

/// From `origin` along `direction`, both in the sensor's frame at `t`; 0: it meets no wall.
double range_m(const Vector3d& origin, const Vector3d& direction, double t) {
  const double from = in_world(origin, t).x();
  const double along = in_world(direction, t).x() - in_world(Vector3d::Zero(), t).x();
  if (along < 0.5) return 0;  // grazing
  const double range = (kWall_m - from) / along;
  return range < kMost_m ? range : 0;
}

struct Worst {
  std::size_t points = 0;
  std::size_t sweeps = 0;
  double apart_m = 0;
};

using Packets = std::vector<std::pair<std::vector<std::uint8_t>, double>>;

Worst deskewed(std::unique_ptr<PacketDecoder> decoder, const Packets& packets) {
  Worst worst;
  const PacketSweeps::Sink sink = [&](Sweep&& sweep) {
    sensors::check_consistent(sweep.scan);
    ++worst.sweeps;
    const double stamp_s = static_cast<double>(sweep.scan.stamp.nanoseconds - kBegin_ns) * 1e-9;
    for (std::size_t i = 0; i < sweep.scan.size(); ++i) {
      const Vector3d p(sweep.scan.x[i], sweep.scan.y[i], sweep.scan.z[i]);
      const double t = stamp_s + static_cast<double>(sweep.scan.time[i]);
      worst.apart_m = std::max(worst.apart_m, std::abs(in_world(p, t).x() - kWall_m));
      ++worst.points;
    }
  };
  PacketSweeps sweeps(std::move(decoder), "lidar", 180);
  for (const auto& [bytes, t] : packets) {
    sweeps.add(bytes, {kBegin_ns + std::llround(t * 1e9)}, sink);
  }
  sweeps.finish(sink);
  EXPECT_EQ(sweeps.counts().data, packets.size());
  EXPECT_EQ(sweeps.counts().returns.points, worst.points);
  return worst;
}

void expect_on_wall(const Worst& worst, double tolerance_m) {
  EXPECT_GE(worst.sweeps, 3U);
  EXPECT_GT(worst.points, 5000U);
  EXPECT_LT(worst.apart_m, tolerance_m);
}

void put16(std::uint8_t* at, std::uint32_t value) {
  at[0] = static_cast<std::uint8_t>(value & 255);
  at[1] = static_cast<std::uint8_t>(value >> 8 & 255);
}

std::uint32_t azimuth_units(double t) {
  return static_cast<std::uint32_t>(std::lround(std::fmod(kTurnRate_deg * t + 360, 360) * 100)) %
         36000;
}

struct VelodyneOrder {
  VelodyneModel model;
  std::uint8_t factory;
  std::size_t banks;  ///< blocks of one firing
  double group_us;
  double unit_m;
  std::function<double(std::size_t)> delay_us;  ///< of the beam in the group
};

Packets velodyne_packets(const VelodyneOrder& order) {
  const auto lasers = velodyne_lasers(order.model);
  const double packet_us = order.group_us * static_cast<double>(12 / order.banks);
  constexpr std::array<std::uint16_t, 4> kFlags{0xEEFF, 0xDDFF, 0xCCFF, 0xBBFF};
  const auto hour_us = static_cast<std::uint32_t>(kBegin_ns / 1000 % 3'600'000'000);
  Packets packets;
  for (int n = 0; n * packet_us < 0.25e6; ++n) {
    // Stamps are whole microseconds.
    const double begin_us = std::round(n * packet_us);
    MadeVelodynePacket packet(0, 0, hour_us + static_cast<std::uint32_t>(begin_us), 0x37,
                              order.factory);
    for (std::size_t block = 0; block < 12; ++block) {
      const double group_us = begin_us + order.group_us * static_cast<double>(block / order.banks);
      packet.set_flag(block, kFlags.at(block % order.banks));
      packet.set_azimuth(block, azimuth_units((group_us + order.delay_us(0)) * 1e-6) / 100.0);
      for (std::size_t k = 0; k < 32; ++k) {
        const std::size_t beam = block % order.banks * 32 + k;
        const VelodyneLaser& laser = lasers[beam % lasers.size()];
        const double t = (group_us + order.delay_us(beam)) * 1e-6;
        const double azimuth = kTurnRate_deg * t * kPerDegree - laser.azimuth_correction;
        const Vector3d direction(std::cos(laser.elevation) * std::cos(azimuth),
                                 -std::cos(laser.elevation) * std::sin(azimuth),
                                 std::sin(laser.elevation));
        // The packet counts by 2 mm.
        packet.set_return(block, k, range_m(Vector3d::Zero(), direction, t) / order.unit_m * 0.002,
                          9);
      }
    }
    const auto bytes = packet.bytes();
    packets.emplace_back(std::vector<std::uint8_t>(bytes.begin(), bytes.end()), begin_us * 1e-6);
  }
  return packets;
}

std::vector<VelodyneOrder> velodyne_orders() {
  return {{VelodyneModel::kVlp16, 0x22, 1, 110.592, 0.002,
           [](std::size_t k) {
             return 55.296 * static_cast<double>(k / 16) + 2.304 * static_cast<double>(k % 16);
           }},
          {VelodyneModel::kVlp16HiRes, 0x24, 1, 110.592, 0.002,
           [](std::size_t k) {
             return 55.296 * static_cast<double>(k / 16) + 2.304 * static_cast<double>(k % 16);
           }},
          {VelodyneModel::kVlp32c, 0x28, 1, 55.296, 0.004,
           [](std::size_t k) { return 2.304 * static_cast<double>(k / 2); }},
          {VelodyneModel::kHdl32e, 0x21, 1, 46.08, 0.002,
           [](std::size_t k) { return 1.152 * static_cast<double>(k); }},
          {VelodyneModel::kVls128, 0xA1, 4, 53.3, 0.004, [](std::size_t k) {
             return -8.7 + 2.665 * static_cast<double>(k / 8) + (k >= 64 ? 2.665 : 0);
           }}};
}

TEST(FiringTimes, OfVelodynesTakeTheMotionOutOfTheSweep) {
  for (const VelodyneOrder& order : velodyne_orders()) {
    SCOPED_TRACE(std::string(name_of(order.model)));
    const Packets packets = velodyne_packets(order);
    ASSERT_EQ(velodyne_model(VelodynePacket(packets[0].first.data(), kVelodynePacketBytes)),
              order.model);
    // Azimuths are sent to 0.01 degrees, which is 11 mm across at 110 m, seen at 60 degrees.
    expect_on_wall(
        deskewed(std::make_unique<VelodyneDecoder>(order.model, velodyne_lasers(order.model)),
                 packets),
        0.03);
  }
}

struct HesaiOrder {
  HesaiModel model;
  std::size_t lasers, blocks;
  std::vector<std::uint8_t> header;
  std::size_t block_head, return_bytes, between, tail_bytes, mode_at, date_at, us_at, end_bytes;
  double base_us, period_us;
  bool from_last;
};

Packets hesai_packets(const HesaiOrder& order) {
  const auto lasers = hesai_lasers(order.model);
  Packets packets;
  const double packet_us = order.period_us * static_cast<double>(order.blocks);
  for (int n = 0; n * packet_us < 0.25e6; ++n) {
    const double stamp_us = std::round(n * packet_us) + 1000;
    std::vector<std::uint8_t> bytes = order.header;
    for (std::size_t block = 0; block < order.blocks; ++block) {
      const double periods =
          order.from_last ? static_cast<double>(block) - static_cast<double>(order.blocks - 1)
                          : static_cast<double>(block);
      const double block_us = stamp_us + order.base_us + order.period_us * periods;
      const std::uint32_t azimuth = azimuth_units(block_us * 1e-6);
      std::vector<std::uint8_t> head(order.block_head, 0);
      if (order.block_head == 4) head = {0xFF, 0xEE, 0, 0};
      put16(head.data() + order.block_head - 2, azimuth);
      bytes.insert(bytes.end(), head.begin(), head.end());
      for (std::size_t k = 0; k < order.lasers; ++k) {
        const double t = (block_us + hesai_firing_us(order.model, k)) * 1e-6;
        const double angle = azimuth / 100.0 * kPerDegree + lasers[k].azimuth_deg * kPerDegree;
        const double elevation = lasers[k].elevation_deg * kPerDegree;
        const Vector3d direction(std::cos(elevation) * std::sin(angle),
                                 std::cos(elevation) * std::cos(angle), std::sin(elevation));
        std::vector<std::uint8_t> unit(order.return_bytes, 7);
        put16(unit.data(), static_cast<std::uint32_t>(
                               std::lround(range_m(Vector3d::Zero(), direction, t) / 0.004)));
        bytes.insert(bytes.end(), unit.begin(), unit.end());
      }
    }
    bytes.insert(bytes.end(), order.between, 0);
    std::vector<std::uint8_t> tail(order.tail_bytes, 0);
    tail[order.mode_at] = 0x37;
    if (order.model == HesaiModel::kPandar128) tail[11] = 2;
    const std::array<std::uint8_t, 6> date{123, 11, 14, 22, 13, 20};  // 1700000000 s
    std::copy(date.begin(), date.end(), tail.begin() + static_cast<std::ptrdiff_t>(order.date_at));
    const auto us = static_cast<std::uint32_t>(stamp_us);
    put16(tail.data() + order.us_at, us & 0xFFFF);
    put16(tail.data() + order.us_at + 2, us >> 16);
    bytes.insert(bytes.end(), tail.begin(), tail.end());
    bytes.insert(bytes.end(), order.end_bytes, 0);
    packets.emplace_back(std::move(bytes), stamp_us * 1e-6);
  }
  return packets;
}

std::vector<HesaiOrder> hesai_orders() {
  const auto header12 = [](int major, int lasers, int blocks, int flags) {
    return std::vector<std::uint8_t>{0xEE,
                                     0xFF,
                                     static_cast<std::uint8_t>(major),
                                     1,
                                     0,
                                     0,
                                     static_cast<std::uint8_t>(lasers),
                                     static_cast<std::uint8_t>(blocks),
                                     0,
                                     4,
                                     1,
                                     static_cast<std::uint8_t>(flags)};
  };
  return {{HesaiModel::kPandar40p, 40, 10, {}, 4, 3, 0, 22, 14, 16, 10, 0, -28.58, 55.56, true},
          {HesaiModel::kPandar64,
           64,
           6,
           {0xEE, 0xFF, 64, 6, 0, 4, 0, 0},
           2,
           3,
           0,
           22,
           14,
           16,
           10,
           4,
           -42.58,
           55.56,
           true},
          {HesaiModel::kXt16, 16, 8, header12(6, 16, 8, 1), 2, 4, 0, 24, 10, 13, 19, 4, 5.632, 50,
           true},
          {HesaiModel::kXt32, 32, 8, header12(6, 32, 8, 1), 2, 4, 0, 24, 10, 13, 19, 4, 5.632, 50,
           true},
          {HesaiModel::kQt64, 64, 4, header12(3, 64, 4, 1), 2, 4, 0, 24, 16, 18, 12, 4, 25.71,
           500.0 / 3, false},
          {HesaiModel::kPandar128, 128, 2, header12(1, 128, 2, 5), 2, 3, 4 + 17, 26, 12, 15, 21, 30,
           3.148, 55.556, true}};
}

TEST(FiringTimes, OfHesaisTakeTheMotionOutOfTheSweep) {
  for (const HesaiOrder& order : hesai_orders()) {
    SCOPED_TRACE(std::string(name_of(order.model)));
    const Packets packets = hesai_packets(order);
    ASSERT_EQ(hesai_model(packets[0].first), order.model) << packets[0].first.size();
    expect_on_wall(
        deskewed(std::make_unique<HesaiDecoder>(order.model, hesai_lasers(order.model)), packets),
        0.01);
  }
}

OusterMetadata made_ouster(OusterProfile profile) {
  OusterMetadata metadata;
  metadata.product = "OS-1-64";
  metadata.profile = profile;
  metadata.origin_to_beam_mm = 15.806;
  metadata.beam_height_mm = 3;
  for (int row = 0; row < 64; ++row) {
    metadata.altitude_deg.push_back(16.6 - 33.2 * row / 63);
    metadata.azimuth_deg.push_back(row % 4 * 2.8 - 4.2);
  }
  return metadata;
}

Packets ouster_packets(const OusterMetadata& metadata) {
  const bool is_legacy = metadata.profile == OusterProfile::kLegacy;
  const bool is_low = metadata.profile == OusterProfile::kLowBandwidth ||
                      metadata.profile == OusterProfile::kDualLowBandwidth;
  const std::size_t pixel = metadata.profile == OusterProfile::kLowBandwidth       ? 4
                            : metadata.profile == OusterProfile::kDualLowBandwidth ? 8
                            : metadata.profile == OusterProfile::kDual             ? 16
                                                                                   : 12;
  const std::size_t column_head = is_legacy ? 16 : 12;
  const double n_m = std::hypot(15.806e-3, 3e-3);
  Packets packets;
  for (std::size_t n = 0; n < 3 * 1024 / 16; ++n) {
    std::vector<std::uint8_t> bytes(ouster_packet_bytes(metadata), 0);
    const std::uint32_t frame = 65534 + static_cast<std::uint32_t>(n / 64);
    if (!is_legacy) {
      bytes[0] = 1;
      put16(bytes.data() + 2, frame & 0xFFFF);
    }
    double t = 0;
    for (std::size_t c = 0; c < 16; ++c) {
      const std::size_t id = (n * 16 + c) % 1024;
      t = static_cast<double>(n * 16 + c) * 0.1 / 1024;
      std::uint8_t* column = bytes.data() + (is_legacy ? 0 : 32) +
                             c * (column_head + 64 * pixel + (is_legacy ? 4 : 0));
      const std::int64_t ns = kBegin_ns + std::llround(t * 1e9);
      std::memcpy(column, &ns, 8);
      put16(column + 8, static_cast<std::uint32_t>(id));
      put16(column + 10, is_legacy ? frame & 0xFFFF : 1);
      if (is_legacy) std::memset(column + 16 + 64 * pixel, 0xFF, 4);
      const double encoder = 2 * std::numbers::pi * (1 - static_cast<double>(id) / 1024);
      for (std::size_t row = 0; row < 64; ++row) {
        const double azimuth = encoder - metadata.azimuth_deg[row] * kPerDegree;
        const double altitude = metadata.altitude_deg[row] * kPerDegree;
        // In the sensor frame, which is the lidar's turned by half a turn and 36.18 mm below.
        const Vector3d direction(-std::cos(altitude) * std::cos(azimuth),
                                 -std::cos(altitude) * std::sin(azimuth), std::sin(altitude));
        const Vector3d origin(-15.806e-3 * std::cos(encoder), -15.806e-3 * std::sin(encoder),
                              3e-3 + 36.18e-3);
        const double range = range_m(origin, direction, kBegin_ns == 0 ? 0 : t);
        const std::uint32_t mm =
            range == 0 ? 0 : static_cast<std::uint32_t>(std::lround((range + n_m) * 1e3));
        const std::uint32_t word = is_low ? (mm + 4) >> 3 : mm;
        std::uint8_t* at = column + column_head + row * pixel;
        std::memcpy(at, &word, is_low ? 2 : 3);
        if (metadata.profile == OusterProfile::kDual) {
          std::memcpy(at + 4, &word, 3);
        }
      }
    }
    packets.emplace_back(std::move(bytes), t);
  }
  return packets;
}

TEST(FiringTimes, OfOustersTakeTheMotionOutOfTheSweep) {
  for (const OusterProfile profile :
       {OusterProfile::kLegacy, OusterProfile::kSingle, OusterProfile::kDual,
        OusterProfile::kLowBandwidth, OusterProfile::kDualLowBandwidth}) {
    SCOPED_TRACE(std::string(name_of(profile)));
    const OusterMetadata metadata = made_ouster(profile);
    const bool is_low =
        profile == OusterProfile::kLowBandwidth || profile == OusterProfile::kDualLowBandwidth;
    expect_on_wall(deskewed(std::make_unique<OusterDecoder>(metadata), ouster_packets(metadata)),
                   is_low ? 0.005 : 0.001);
  }
}

sensors::LidarProfile profile_of(const std::string& name) {
  return sensors::load_lidar_profile(std::string(TRAVERSE_SHARE_DIR) + "/sensors/" + name +
                                     ".yaml");
}

/// Beams by elevation, the lowest first: models do not agree in which ring is the first.
std::vector<std::size_t> by_elevation(const std::vector<double>& elevations_deg) {
  std::vector<std::size_t> order(elevations_deg.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return elevations_deg[a] < elevations_deg[b];
  });
  return order;
}

/// Each point that the decoder makes lies where the profile's beam points when that fires: what
/// remains of its azimuth after the turn of the head until then and the beam's offset is the same
/// for all beams, as is the moment of the firing's start modulo the period.
void expect_profile_fits(const sensors::LidarProfile& profile,
                         std::unique_ptr<PacketDecoder> decoder, const Packets& packets,
                         const std::vector<double>& elevations_deg, double turned_zero_deg) {
  const std::size_t beams = elevations_deg.size();
  ASSERT_EQ(profile.elevations_deg.size(), beams);
  std::vector<std::size_t> in_profile(beams);
  const auto of_packets = by_elevation(elevations_deg);
  const auto of_profile = by_elevation(profile.elevations_deg);
  for (std::size_t i = 0; i < beams; ++i) in_profile[of_packets[i]] = of_profile[i];

  double elevation_off = 0;
  double azimuth_off = 0;
  double time_off_us = 0;
  std::size_t points = 0;
  std::optional<double> start_us;
  const PacketSweeps::Sink sink = [&](Sweep&& sweep) {
    const std::int64_t stamp_ns = sweep.scan.stamp.nanoseconds - kBegin_ns;
    for (std::size_t i = 0; i < sweep.scan.size(); ++i) {
      const std::size_t beam = in_profile[sweep.scan.ring[i]];
      const double t =
          static_cast<double>(stamp_ns) * 1e-9 + static_cast<double>(sweep.scan.time[i]);
      const double across = std::hypot(sweep.scan.x[i], sweep.scan.y[i]);
      elevation_off =
          std::max(elevation_off, std::abs(std::atan2(sweep.scan.z[i], across) / kPerDegree -
                                           profile.elevations_deg[beam]));
      const auto& firing = profile.firing;
      const double offset =
          firing.azimuth_offsets_deg.empty() ? 0 : firing.azimuth_offsets_deg[beam];
      const double azimuth = std::atan2(sweep.scan.y[i], sweep.scan.x[i]) / kPerDegree;
      azimuth_off = std::max(
          azimuth_off,
          std::abs(std::remainder(azimuth + kTurnRate_deg * t - offset - turned_zero_deg, 360)));
      const double after_us = firing.times_us.empty() ? 0 : firing.times_us[beam];
      // Packets are a whole number of firings long and their stamps whole microseconds.
      const double begin_us = t * 1e6 - after_us;
      if (!start_us) start_us = begin_us;
      time_off_us = std::max(
          time_off_us, std::abs(std::remainder(begin_us - *start_us, profile.firing.period_us)));
      ++points;
    }
  };
  PacketSweeps sweeps(std::move(decoder), "lidar", 180);
  for (const auto& [bytes, t] : packets) {
    sweeps.add(bytes, {kBegin_ns + std::llround(t * 1e9)}, sink);
  }
  sweeps.finish(sink);
  EXPECT_GT(points, 5000U);
  EXPECT_LT(elevation_off, 0.002) << "degrees, which are told to a thousandth";
  EXPECT_LT(azimuth_off, 0.02) << "degrees, of which packets tell hundredths";
  EXPECT_LT(time_off_us, 1.1) << "of which packets tell whole ones";
}

TEST(FiringTimes, ProfilesToSimulateFireAsThePacketsTell) {
  const std::vector<std::string> velodynes{"vlp16", "", "vlp32c", "hdl32e", "vls128"};
  const auto orders = velodyne_orders();
  ASSERT_EQ(orders.size(), velodynes.size());
  for (std::size_t i = 0; i < orders.size(); ++i) {
    if (velodynes[i].empty()) continue;  // of the Puck Hi-Res there is none
    SCOPED_TRACE(velodynes[i]);
    const auto lasers = velodyne_lasers(orders[i].model);
    std::vector<double> elevations_deg;
    for (const VelodyneLaser& laser : lasers)
      elevations_deg.push_back(laser.elevation / kPerDegree);
    expect_profile_fits(profile_of(velodynes[i]),
                        std::make_unique<VelodyneDecoder>(orders[i].model, lasers),
                        velodyne_packets(orders[i]), elevations_deg, 0);
  }
  const std::vector<std::string> hesais{"pandar40p", "pandar64", "xt16",
                                        "xt32",      "qt64",     "pandar128"};
  const auto hesai = hesai_orders();
  ASSERT_EQ(hesai.size(), hesais.size());
  for (std::size_t i = 0; i < hesai.size(); ++i) {
    SCOPED_TRACE(hesais[i]);
    const auto lasers = hesai_lasers(hesai[i].model);
    std::vector<double> elevations_deg;
    for (const HesaiLaser& laser : lasers) elevations_deg.push_back(laser.elevation_deg);
    expect_profile_fits(profile_of(hesais[i]),
                        std::make_unique<HesaiDecoder>(hesai[i].model, lasers),
                        hesai_packets(hesai[i]), elevations_deg, 90);
  }
}

/// The sign of an Ouster's azimuths: a profile's offsets are counterclockwise, its metadata's not.
TEST(FiringTimes, OffsetsOfAnOusterAreThoseOfItsMetadataMirrored) {
  const sensors::LidarProfile profile = profile_of("os1_64");
  OusterMetadata metadata = made_ouster(OusterProfile::kSingle);
  metadata.origin_to_beam_mm = metadata.beam_height_mm = 0;  // what profiles leave out
  metadata.altitude_deg = profile.elevations_deg;
  for (std::size_t row = 0; row < 64; ++row) {
    metadata.azimuth_deg[row] = -profile.firing.azimuth_offsets_deg[row];
  }
  const std::vector<std::uint8_t> one_range = [&] {
    std::vector<std::uint8_t> bytes(ouster_packet_bytes(metadata), 0);
    bytes[0] = 1;
    for (std::size_t c = 0; c < 16; ++c) {
      std::uint8_t* column = bytes.data() + 32 + c * (12 + 64 * 12);
      const auto ns = static_cast<std::int64_t>(static_cast<double>(c) * 0.1e9 / 1024);
      std::memcpy(column, &ns, 8);
      put16(column + 8, static_cast<std::uint32_t>(c));
      put16(column + 10, 1);
      for (std::size_t row = 0; row < 64; ++row) put16(column + 12 + row * 12, 10'000);
    }
    return bytes;
  }();
  OusterDecoder decoder(metadata);
  PacketOutline outline;
  ASSERT_EQ(decoder.outline(one_range, outline), PacketKind::kData);
  sensors::LidarScan scan;
  decoder.append(one_range, outline, 0, outline.groups, 0, scan);
  ASSERT_EQ(scan.size(), 16U * 64U);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    // The first column looks behind; the head turns clockwise.
    const double expected = 180 - kTurnRate_deg * static_cast<double>(scan.time[i]) +
                            profile.firing.azimuth_offsets_deg[scan.ring[i]];
    const double azimuth = std::atan2(scan.y[i], scan.x[i]) / kPerDegree;
    EXPECT_LT(std::abs(std::remainder(azimuth - expected, 360)), 1e-3) << i;
  }
  EXPECT_NEAR(profile_of("os1_128").firing.azimuth_offsets_deg[0], -4.25, 0.01);
  EXPECT_NEAR(profile_of("os1_128").elevations_deg[0], 21.476, 0.001);
}

}  // namespace
}  // namespace traverse::packets
