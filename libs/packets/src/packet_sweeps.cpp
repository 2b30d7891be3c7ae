#include "traverse/packets/packet_sweeps.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "saturated_sum.hpp"

namespace traverse::packets {

namespace {

constexpr std::int64_t kPause_ns = 250'000'000;
/// The azimuth of an HDL-64E trembles by some hundredths of a degree.
constexpr std::int32_t kTremble = 100;
/// Packets that the network brought so much out of turn belong to the frame before.
constexpr int kLateFrames = 8;

/// All columns: packets tell intensity, time and ring of each point.
void reserve(sensors::LidarScan& scan, std::size_t points) {
  scan.reserve(points);
  scan.intensity.reserve(points);
  scan.time.reserve(points);
  scan.ring.reserve(points);
}

std::int16_t frames_after(std::uint32_t frame, std::uint32_t other) {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(frame - other));
}

}  // namespace

PacketSweeps::PacketSweeps(std::unique_ptr<PacketDecoder> decoder, std::string label,
                           double seam_azimuth_deg)
    : decoder_(std::move(decoder)),
      label_(std::move(label)),
      seam_(static_cast<std::int32_t>(std::lround(seam_azimuth_deg * 100)) % PacketOutline::kTurn),
      clock_(decoder_->clock_period_ns()) {}

bool PacketSweeps::begins_sweep(std::int32_t azimuth) {
  constexpr std::int32_t kTurn = PacketOutline::kTurn;
  const std::int32_t turned = (azimuth - seam_ + 2 * kTurn) % kTurn;
  if (!last_turned_) {
    last_turned_ = turned;
    return false;
  }
  const std::int32_t on = (turned - *last_turned_ + kTurn) % kTurn;
  if (on > kTurn - kTremble) return false;  // back a little
  const bool passes = turned < *last_turned_;
  turned_ += on;
  last_turned_ = turned;
  return passes;
}

void PacketSweeps::close(const Sink& sink) {
  if (!is_open_) return;
  is_open_ = false;
  sweep_.turned_deg = static_cast<double>(turned_) / 100;
  turned_ = 0;
  if (sweep_.scan.empty()) return;
  usual_points_ = std::max(usual_points_, sweep_.scan.size());
  sink(std::move(sweep_));
  sweep_ = {};
}

void PacketSweeps::add(Bytes packet, geometry::Stamp arrival, const Sink& sink) {
  ++counts_.packets;
  switch (decoder_->outline(packet, outline_)) {
    case PacketKind::kOther:
      ++counts_.other;
      return;
    case PacketKind::kDamaged:
      ++counts_.damaged;
      return;
    case PacketKind::kData:
      break;
  }
  ++counts_.data;
  const auto [sensed, is_step] = clock_.at(outline_.sensor_ns, arrival);
  const geometry::Stamp stamp = sensed;
  if (outline_.has_frame && frame_ && is_open_) {
    const int after = frames_after(outline_.frame, *frame_);
    if (after < 0 && after >= -kLateFrames) {
      ++counts_.late;
      return;
    }
    if (after != 0) close(sink);
  }
  if (outline_.has_frame) frame_ = outline_.frame;
  const bool pauses = last_stamp_ && std::llabs(saturated_difference(
                                         stamp.nanoseconds, last_stamp_->nanoseconds)) > kPause_ns;
  if (is_step || pauses) {
    close(sink);
    last_turned_.reset();
  }
  last_stamp_ = stamp;

  const auto append = [&](std::size_t first, std::size_t last) {
    if (first == last) return;
    if (!is_open_) {
      is_open_ = true;
      sweep_.scan.stamp =
          geometry::Stamp{saturated_sum(stamp.nanoseconds, outline_.begin_ns[first])};
      sweep_.scan.sensor = label_;
      reserve(sweep_.scan, usual_points_ + usual_points_ / 16);
    }
    const double zero_s = geometry::seconds_between(sweep_.scan.stamp, stamp);
    counts_.returns += decoder_->append(packet, outline_, first, last, zero_s, sweep_.scan);
  };
  std::size_t first = 0;
  for (std::size_t group = 0; group < outline_.groups; ++group) {
    const std::int64_t before = turned_;
    if (!begins_sweep(outline_.azimuth[group]) || outline_.has_frame) continue;
    append(first, group);
    const std::int64_t on = turned_ - before;
    close(sink);
    turned_ = on;
    first = group;
  }
  append(first, outline_.groups);
}

void PacketSweeps::finish(const Sink& sink) {
  close(sink);
  last_turned_.reset();
  last_stamp_.reset();
  frame_.reset();
}

}  // namespace traverse::packets
