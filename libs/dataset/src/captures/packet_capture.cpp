#include "captures/packet_capture.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"
#include "traverse/packets/packet_lidars.hpp"
#include "traverse/packets/udp_capture.hpp"

#include "captures/ouster_choice.hpp"
#include "captures/packet_tally.hpp"
#include "point_clouds/point_statements.hpp"
#include "recording/arrival_queue.hpp"
#include "recording/folder_opening.hpp"
#include "recording/gga_quality_fact.hpp"
#include "recording/unused_files.hpp"

namespace traverse::dataset {

using packets::PacketLidars;
using packets::PacketMeasurement;
using sensors::Measurement;
using sensors::SensorKind;

namespace {

namespace fs = std::filesystem;

/// How much is read ahead to learn which sensors there are: a second of an OS-1-128 and more.
constexpr std::size_t kPreviewDatagrams = 4000;

class CaptureSource : public Source {
 public:
  CaptureSource(const fs::path& file, const OpenOptions& options, std::string_view format)
      : file_(file),
        statements_(fs::path(file).replace_extension(".traverse.yaml"), options,
                    file.parent_path()),
        info_(begin_info(file, format, statements_, "lidar")),
        ouster_(stated_ouster(statements_)) {
    if (!ouster_) ouster_ = ouster_beside(file);
    set_motion_compensation(info_, statements_, false, "packets are as measured");
    if (ouster_) note_ouster(*ouster_, info_.facts);
    rewind();
    preview(options);
    set_camera(info_, statements_, {});
    if (stated_reference(statements_)) {
      reference_ = choose_reference(info_, statements_, std::nullopt, all_scan_stamps());
    }
    note_unused_files(info_, options, reference_, 0);
    rewind();
  }

  const RecordingInfo& info() const override { return info_; }
  const SkippedRecords& skipped() const override { return queue_.skipped(); }
  const std::optional<Reference>& reference() const override { return reference_; }
  std::optional<double> share_read() const override {
    const auto size = static_cast<double>(fs::file_size(file_));
    return size > 0 ? std::min(1.0, static_cast<double>(capture_->bytes_read()) / size) : 1.0;
  }

  std::optional<Measurement> next() override {
    return queue_.next([&] { read_datagram(); });
  }

  void rewind() override {
    capture_.emplace(file_);
    lidars_ = PacketLidars(ouster_ ? std::optional(ouster_->metadata) : std::nullopt);
    queue_ = ArrivalQueue(ArrivalQueue::Clock::kSteady);  // sensors' clocks are followed below it
    tally_ = {};
    cut_ = 0;
    incomplete_ = 0;
    datagrams_ = 0;
  }

 private:
  void read_datagram() {
    const std::string place = fmt::format("datagram {}", datagrams_ + 1);
    const PacketLidars::Sink sink = [this, &place](PacketMeasurement&& found) {
      const auto* fix = std::get_if<sensors::GnssFix>(&found.measurement);
      if (fix != nullptr && fix->covariance_enu) {  // of a sentence, which tells a code alone
        note_gga_quality(*fix->covariance_enu, info_.facts);
      }
      queue_.push(std::move(found.measurement), place);
    };
    if (const auto datagram = capture_->next()) {
      ++datagrams_;
      stream_.assign(datagram->source.begin(), datagram->source.end());
      stream_ += fmt::format(" {}", datagram->target_port);
      lidars_.add(stream_, datagram->payload, datagram->arrival, sink);
    } else {
      lidars_.finish(sink);
      queue_.finish();
      if (!capture_->fault().empty()) {
        queue_.skipped().add("the rest of the capture cannot be read: " + capture_->fault(), place);
      }
      note_packets(lidars_, info_.facts);
    }
    tally_.tell(lidars_, place, queue_.skipped());
    const auto& frames = capture_->counts();
    tell_skipped("frame that was cut short", frames.cut, cut_, place, queue_.skipped());
    tell_skipped("datagram of which fragments are missing", frames.incomplete, incomplete_, place,
                 queue_.skipped());
  }

  /// Reads the beginning, so that info() knows the sensors.
  void preview(const OpenOptions& options) {
    std::set<SensorKind> kinds;
    const PacketLidars::Sink sink = [&](PacketMeasurement&& found) {
      if (std::holds_alternative<sensors::ImuSample>(found.measurement)) {
        kinds.insert(SensorKind::kImu);
      }
      if (std::holds_alternative<sensors::GnssFix>(found.measurement)) {
        kinds.insert(SensorKind::kGnss);
      }
    };
    for (std::size_t i = 0; i < kPreviewDatagrams; ++i) {
      const auto datagram = capture_->next();
      if (!datagram) break;
      stream_.assign(datagram->source.begin(), datagram->source.end());
      stream_ += fmt::format(" {}", datagram->target_port);
      lidars_.add(stream_, datagram->payload, datagram->arrival, sink);
    }
    if (lidars_.lidars().empty()) refuse();
    for (const packets::PacketLidar& lidar : lidars_.lidars()) {
      const bool is_first = info_.rig.sensors.empty();
      const ProfileChoice choice = choose_profile(
          statements_, options.share_folder,
          {lidar.profile, fmt::format("by its packets: {} {}", lidar.maker, lidar.model)});
      info_.rig.sensors.push_back(
          {lidar.label, SensorKind::kLidar, geometry::Pose3::identity(), choice.profile});
      const std::string prefix = is_first ? "" : lidar.label + ": ";
      add_profile_facts(choice, statements_, prefix, info_.facts);
      note_idle_point_statements(statements_, prefix, kPacketsTellAll, info_.facts);
      const auto& clock = lidars_.clock(info_.rig.sensors.size() - 1);
      info_.facts.push_back(clock_fact(clock.is_absolute(), prefix));
    }
    if (kinds.contains(SensorKind::kImu) && ouster_) {
      info_.rig.sensors.push_back({PacketLidars::kImu, SensorKind::kImu,
                                   ouster_imu_mounting(ouster_->metadata), std::nullopt});
      apply_vehicle(statements_, info_.rig.sensors.back());
    }
    if (kinds.contains(SensorKind::kGnss)) {
      info_.rig.sensors.push_back(
          {PacketLidars::kGnss, SensorKind::kGnss, geometry::Pose3::identity(), std::nullopt});
      apply_vehicle(statements_, info_.rig.sensors.back());
    }
    if (const auto apart_s = lidars_.statistics().clock_apart_s) {
      info_.facts.push_back(
          {"clock of the lidar against its receiver",
           fmt::format("{:.3f} s after the second that the sentence tells", *apart_s),
           std::abs(*apart_s) < 2
               ? "position packets; a receiver tells its second within it"
               : "position packets; the lidar does not keep the receiver's time"});
    }
  }

  [[noreturn]] void refuse() const {
    const auto& found = lidars_.statistics();
    if (found.of_other_ouster > 0) {
      throw files::InputError(
          file_, files::Place::whole_file(),
          "an Ouster's metadata, the only *.json beside the capture or stated by `--recording "
          "lidar.metadata=FILE`",
          ouster_ ? fmt::format("packets that are not of {}", ouster_->from)
                  : fmt::format("{} packets of an Ouster and no metadata, or several",
                                found.of_other_ouster));
    }
    throw files::InputError(file_, files::Place::whole_file(),
                            "packets of a Velodyne, a Hesai or an Ouster near the beginning",
                            fmt::format("{} frames with {} datagrams of UDP, none of these",
                                        capture_->counts().frames, capture_->counts().datagrams));
  }

  /// For poses without stamps, one a scan.
  PoseStamps all_scan_stamps() {
    PoseStamps stamps;
    rewind();
    const std::string label = lidar_label();
    while (const auto measurement = next()) {
      if (std::holds_alternative<std::shared_ptr<const sensors::LidarScan>>(*measurement) &&
          sensors::sensor_of(*measurement) == label) {
        stamps.emplace_back(sensors::stamp_of(*measurement));
      }
    }
    return stamps;
  }

  std::string lidar_label() const { return info_.rig.first(SensorKind::kLidar)->label; }

  fs::path file_;
  Statements statements_;
  RecordingInfo info_;
  std::optional<OusterChoice> ouster_;
  std::optional<Reference> reference_;

  std::optional<packets::UdpCapture> capture_;
  PacketLidars lidars_;
  std::string stream_;
  ArrivalQueue queue_;
  PacketTally tally_;
  std::size_t cut_ = 0;         ///< frames that were told
  std::size_t incomplete_ = 0;  ///< datagrams that were told
  std::size_t datagrams_ = 0;
};

}  // namespace

bool is_packet_capture(const fs::path& file) {
  const fs::path extension = file.extension();
  return extension == ".pcap" || extension == ".pcapng" || packets::is_capture(file);
}

std::unique_ptr<Source> open_packet_capture(const fs::path& file, const OpenOptions& options,
                                            std::string_view format) {
  return std::make_unique<CaptureSource>(file, options, format);
}

}  // namespace traverse::dataset
