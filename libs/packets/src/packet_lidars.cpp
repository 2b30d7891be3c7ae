#include "traverse/packets/packet_lidars.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "traverse/packets/velodyne.hpp"

#include "byte_fields.hpp"
#include "hesai.hpp"
#include "nmea.hpp"
#include "ouster.hpp"
#include "velodyne_position.hpp"

namespace traverse::packets {

struct PacketLidars::Stream {
  std::size_t lidar;
  PacketSweeps sweeps;
};

namespace {

struct FoundLidar {
  std::string model;
  std::string maker;
  std::unique_ptr<PacketDecoder> decoder;
  std::vector<double> elevations_deg;
  double max_range_m = 120;
  double seam_azimuth_deg = 180;  ///< in the sense of the turn
};

std::optional<FoundLidar> find_velodyne(Bytes packet) {
  if (packet.size() != kVelodynePacketBytes) return std::nullopt;
  const VelodynePacket bytes(packet.data(), kVelodynePacketBytes);
  const auto model = velodyne_model(bytes);
  if (!model || !is_velodyne_data(bytes)) return std::nullopt;
  const auto lasers = velodyne_lasers(*model);
  if (lasers.empty()) return std::nullopt;
  FoundLidar found{std::string(name_of(*model)),
                   "Velodyne",
                   std::make_unique<VelodyneDecoder>(*model, lasers),
                   {}};
  for (const VelodyneLaser& laser : lasers) {
    found.elevations_deg.push_back(laser.elevation * 180 / std::numbers::pi);
  }
  if (*model == VelodyneModel::kVlp32c) found.max_range_m = 200;
  if (*model == VelodyneModel::kVls128) found.max_range_m = 245;
  return found;
}

std::optional<FoundLidar> find_hesai(Bytes packet) {
  const auto model = hesai_model(packet);
  if (!model) return std::nullopt;
  const auto lasers = hesai_lasers(*model);
  FoundLidar found{std::string(name_of(*model)),
                   "Hesai",
                   std::make_unique<HesaiDecoder>(*model, lasers),
                   {},
                   200};
  for (const HesaiLaser& laser : lasers) found.elevations_deg.push_back(laser.elevation_deg);
  if (*model == HesaiModel::kQt64) found.max_range_m = 60;
  return found;
}

std::optional<FoundLidar> find_ouster(Bytes packet, const std::optional<OusterMetadata>& metadata) {
  if (!metadata || packet.size() != ouster_packet_bytes(*metadata)) return std::nullopt;
  const std::string product = metadata->product.empty() ? "Ouster" : metadata->product;
  FoundLidar found{product, "Ouster", std::make_unique<OusterDecoder>(*metadata), {}};
  found.elevations_deg = metadata->altitude_deg;
  return found;
}

sensors::LidarProfile profile_of(const FoundLidar& found, double sweep_s) {
  sensors::LidarProfile profile;
  profile.name = found.model;
  profile.rings = static_cast<int>(found.elevations_deg.size());
  profile.elevations_deg = found.elevations_deg;
  profile.max_range_m = found.max_range_m;
  profile.ring_source = sensors::RingSource::kData;
  profile.time_source = sensors::TimeSource::kData;
  profile.rotation = sensors::Rotation::kClockwise;
  profile.seam_azimuth_deg = 180;
  profile.stamp_fraction = 0;
  profile.sweep_s = sweep_s;
  return profile;
}

}  // namespace

PacketLidars::PacketLidars(std::optional<OusterMetadata> ouster, std::string label)
    : ouster_(std::move(ouster)), label_(std::move(label)) {}
PacketLidars::~PacketLidars() = default;
PacketLidars::PacketLidars(PacketLidars&&) noexcept = default;
PacketLidars& PacketLidars::operator=(PacketLidars&&) noexcept = default;

PacketLidars::Stream* PacketLidars::stream_for(const std::string& name, Bytes packet) {
  const auto known = streams_.find(name);
  if (known != streams_.end()) return known->second.get();
  auto found = find_velodyne(packet);
  if (!found) found = find_hesai(packet);
  if (!found) found = find_ouster(packet, ouster_);
  if (!found) return nullptr;
  const std::size_t lidar = lidars_.size();
  const std::string label = lidar == 0 ? label_ : fmt::format("{} {}", label_, lidar + 1);
  const double sweep_s =
      found->maker == "Ouster" && ouster_ ? 1 / ouster_->turns_per_second() : 0.1;
  lidars_.push_back({label, found->model, found->maker, profile_of(*found, sweep_s)});
  auto stream = std::make_unique<Stream>(
      Stream{lidar, PacketSweeps(std::move(found->decoder), label, found->seam_azimuth_deg)});
  by_lidar_.push_back(stream.get());
  return streams_.emplace(name, std::move(stream)).first->second.get();
}

PacketSweeps::Sink PacketLidars::scans_to(std::size_t lidar, const Sink& sink) {
  return [this, lidar, &sink](Sweep&& sweep) {
    constexpr double kLeastTurn_deg = 180;
    if (sweep.turned_deg < kLeastTurn_deg) {
      ++statistics_.part_sweeps;
      statistics_.part_sweep_points += sweep.scan.size();
      return;
    }
    sink({std::make_shared<const sensors::LidarScan>(std::move(sweep.scan)), lidar});
  };
}

void PacketLidars::add(const std::string& stream_name, Bytes packet, geometry::Stamp arrival,
                       const Sink& sink) {
  ++statistics_.packets;
  if (packet.size() == kVelodynePositionBytes) return add_position(packet, arrival, sink);
  if (ouster_ && packet.size() == kOusterImuBytes) return add_imu(packet, arrival, sink);
  Stream* stream = stream_for(stream_name, packet);
  if (stream == nullptr) {
    ++(looks_like_ouster(packet) ? statistics_.of_other_ouster : statistics_.unknown);
    return;
  }
  stream->sweeps.add(packet, arrival, scans_to(stream->lidar, sink));
}

void PacketLidars::add_position(Bytes packet, geometry::Stamp arrival, const Sink& sink) {
  const auto position = decode_velodyne_position(packet);
  ++statistics_.positions;
  if (!position || position->sentence.empty() || position->sentence == last_sentence_) return;
  last_sentence_ = position->sentence;
  ++statistics_.sentences;
  if (!has_nmea_checksum(position->sentence)) {
    ++statistics_.bad_sentences;
    return;
  }
  const auto fix = parse_nmea_fix(position->sentence);
  if (!fix) return;
  constexpr std::int64_t kHour_ns = 3'600'000'000'000;
  const double second_of_hour = std::fmod(fix->seconds_of_day, 3600);
  double apart_s = position->microseconds * 1e-6 - second_of_hour;
  if (apart_s > 1800) apart_s -= 3600;
  if (apart_s < -1800) apart_s += 3600;
  if (!statistics_.clock_apart_s || std::abs(apart_s) > std::abs(*statistics_.clock_apart_s)) {
    statistics_.clock_apart_s = apart_s;
  }
  // The second that the sentence tells began so long before the packet was sent.
  constexpr double kUsual_s = 2;
  const bool keeps_time = std::abs(apart_s) < kUsual_s;
  SensorClock hour(kHour_ns);
  sensors::GnssFix measured;
  measured.stamp =
      keeps_time
          ? hour.at(static_cast<std::int64_t>(std::llround(second_of_hour * 1e9)), arrival).stamp
          : arrival;
  if (keeps_time && !by_lidar_.empty()) {
    // On the clock of the scans.
    SensorClock& clock = by_lidar_.front()->sweeps.clock();
    measured.stamp = geometry::shifted(
        clock.at(static_cast<std::int64_t>(position->microseconds) * 1000, arrival).stamp,
        -apart_s);
  }
  measured.sensor = kGnss;
  measured.latitude_deg = fix->latitude_deg;
  measured.longitude_deg = fix->longitude_deg;
  measured.covariance_enu = fix->covariance_enu;
  if (fix->altitude_m) last_altitude_ = fix->altitude_m;
  measured.altitude_m = last_altitude_.value_or(std::numeric_limits<double>::quiet_NaN());
  ++statistics_.fixes;
  sink({measured, 0});
}

void PacketLidars::add_imu(Bytes packet, geometry::Stamp arrival, const Sink& sink) {
  const auto reading = decode_ouster_imu(packet);
  if (!reading) {
    ++statistics_.unknown;
    return;
  }
  const auto lidar = std::find_if(lidars_.begin(), lidars_.end(),
                                  [](const PacketLidar& found) { return found.maker == "Ouster"; });
  SensorClock& clock =
      lidar == lidars_.end()
          ? ouster_clock_
          : by_lidar_[static_cast<std::size_t>(lidar - lidars_.begin())]->sweeps.clock();
  sensors::ImuSample sample;
  sample.stamp = clock.at(reading->sensor_ns, arrival).stamp;
  sample.sensor = kImu;
  sample.angular_rate = reading->angular_rate;
  sample.specific_force = reading->specific_force;
  ++statistics_.imu;
  sink({sample, 0});
}

void PacketLidars::finish(const Sink& sink) {
  for (Stream* stream : by_lidar_) stream->sweeps.finish(scans_to(stream->lidar, sink));
}

const PacketCounts& PacketLidars::counts(std::size_t lidar) const {
  return by_lidar_.at(lidar)->sweeps.counts();
}

const SensorClock& PacketLidars::clock(std::size_t lidar) const {
  return by_lidar_.at(lidar)->sweeps.clock();
}

bool looks_like_ouster(Bytes packet) {
  constexpr std::array<std::size_t, 5> kRows{16, 32, 64, 96, 128};
  for (const std::size_t rows : kRows) {
    if (packet.size() == 16 * (16 + rows * 12 + 4)) return true;
    for (const std::size_t pixel : {4U, 8U, 12U, 16U}) {
      const bool has_size = packet.size() == 32 + 16 * (12 + rows * pixel) + 32;
      if (has_size && u16_at(packet.data()) == 1) return true;
    }
  }
  return false;
}

}  // namespace traverse::packets
