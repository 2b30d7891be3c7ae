#include "bags/bag_source.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "traverse/bags/message_value.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/packets/packet_lidars.hpp"
#include "traverse/statistics/quantile.hpp"

#include "bags/bag_files.hpp"
#include "bags/bag_mounting.hpp"
#include "bags/companion_topics.hpp"
#include "bags/frame_tree.hpp"
#include "bags/packet_topics.hpp"
#include "bags/ros_messages.hpp"
#include "bags/topic_choice.hpp"
#include "captures/ouster_choice.hpp"
#include "captures/packet_tally.hpp"
#include "point_clouds/point_fields.hpp"
#include "point_clouds/point_statements.hpp"
#include "recording/arrival_queue.hpp"
#include "recording/folder_opening.hpp"
#include "recording/gga_quality_fact.hpp"
#include "recording/measurement_statements.hpp"
#include "recording/profile_choice.hpp"
#include "recording/unused_files.hpp"

namespace traverse::dataset {

using files::InputError;
using files::Place;
using geometry::Stamp;
using sensors::Measurement;
using sensors::SensorKind;

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kExampleScans = 5;

fs::path bag_sidecar(const fs::path& path) {
  return fs::is_directory(path) ? path / "traverse.yaml"
                                : fs::path(path).replace_extension(".traverse.yaml");
}

/// What is known of a topic of clouds or packets.
struct BagLidar {
  ProfileChoice profile;
  PointFields fields;  ///< of clouds
};

/// What takes a topic's packets, and an Ouster's IMU's with them.
struct PacketsOfTopic {
  packets::PacketLidars lidars;
  PacketTally tally;
};

struct BagBookmark : Bookmark {
  std::shared_ptr<const bags::Position> position;
  ArrivalQueue queue;
  StatedMeasurements stated;
  CompanionReadings beside;

  explicit BagBookmark(StatedMeasurements stated_now) : stated(std::move(stated_now)) {}
};

class BagSource : public Source {
 public:
  BagSource(const fs::path& path, const OpenOptions& options, std::string_view format)
      : path_(path),
        statements_(bag_sidecar(path), options, fs::is_directory(path) ? path : path.parent_path()),
        info_(begin_info(path, format, statements_, "body")),
        stated_(statements_->imu, statements_->gnss) {
    container_ = open_bag_files(path, info_.facts);
    info_.facts.push_back({"messages",
                           fmt::format("{} of {} topics", container_->contents().messages,
                                       container_->contents().channels.size()),
                           container_->contents().how});
    topics_ = peek_topics(*container_, statements_->wheel_joints);
    ouster_ = ouster_of_bag(*container_, topics_, statements_, path_);
    if (ouster_) note_ouster(*ouster_, info_.facts);
    peek_packets(*container_, ouster_, topics_);
    frames_ = read_frames(*container_, topics_);
    chosen_ = choose_topics(topics_, frames_, statements_, info_);
    info_.is_listed = true;
    if (options.wants_measurements) refuse_nothing();
    set_motion_compensation(info_, statements_, false, "default, not stated");
    mount(options);
    set_camera(info_, statements_, {});
    const auto* lidar = info_.rig.first(SensorKind::kLidar);
    if (lidar != nullptr && info_.T_body_camera) {
      info_.T_body_camera = lidar->T_body_sensor * *info_.T_body_camera;
    }
    read_reference(options, lidar);
    note_unused_files(info_, options, reference_, 0);
    BagSource::rewind();
  }

  const RecordingInfo& info() const override { return info_; }
  const SkippedRecords& skipped() const override { return queue_.skipped(); }
  const std::optional<Reference>& reference() const override { return reference_; }
  std::optional<double> share_read() const override { return container_->share_read(); }

  std::optional<Measurement> next() override {
    return queue_.next([&] { read_message(); });
  }

  void rewind() override {
    std::vector<std::size_t> channels;
    for (const auto& [index, label] : labels_) channels.push_back(topics_[index].channel);
    for (const auto& beside : {chosen_.headings, chosen_.pulses}) {
      if (beside) channels.push_back(topics_[*beside].channel);
    }
    beside_ = {};
    container_->begin(channels);
    stated_ = {statements_->imu, statements_->gnss};
    packets_.clear();
    for (const std::size_t topic : lidar_topics()) add_packets_of(topics_[topic].topic);
    if (packets_.empty()) add_packets_of("lidar");
    queue_ = ArrivalQueue();
  }

  std::shared_ptr<const Bookmark> bookmark() const override {
    // A turn of which half is read is large, and begun by packets that are not read again.
    if (takes_packets()) return nullptr;
    auto here = std::make_shared<BagBookmark>(stated_);
    here->position = container_->position();
    here->queue = queue_;
    here->beside = beside_;
    return here;
  }

  void return_to(const Bookmark& bookmark) override {
    const auto& there = dynamic_cast<const BagBookmark&>(bookmark);
    container_->return_to(*there.position);
    stated_ = there.stated;
    queue_ = there.queue;
    beside_ = there.beside;
  }

 private:
  bool takes_packets() const {
    return std::any_of(labels_.begin(), labels_.end(),
                       [&](const auto& label) { return holds_packets(topics_[label.first]); });
  }
  static bool holds_packets(const PeekedTopic& topic) {
    return topic.kind == TopicKind::kPackets || topic.kind == TopicKind::kImuPackets;
  }

  /// A run of nothing is refused by what there is.
  void refuse_nothing() const {
    if (chosen_.lidar || chosen_.imu || chosen_.gnss || chosen_.wheels || chosen_.laser) return;
    std::string found;
    for (const TopicInfo& topic : info_.topics) {
      if (topic.use == "transforms") continue;
      found += fmt::format("{}{} ({}): {}", found.empty() ? "" : "; ", topic.topic, topic.type,
                           topic.why);
    }
    throw InputError(path_, Place::whole_file(),
                     "a topic of points, an IMU, a GNSS receiver or wheels that can be read",
                     found.empty() ? "none with messages" : found);
  }

  std::vector<std::size_t> lidar_topics() const {
    std::vector<std::size_t> all;
    if (chosen_.lidar) all.push_back(*chosen_.lidar);
    all.insert(all.end(), chosen_.more_lidars.begin(), chosen_.more_lidars.end());
    return all;
  }

  void add_packets_of(const std::string& label) {
    packets_.push_back(
        {packets::PacketLidars(ouster_ ? std::optional(ouster_->metadata) : std::nullopt, label),
         {}});
  }

  /// Those of the topic; an IMU's are the first lidar's.
  PacketsOfTopic& packets_of(const PeekedTopic& topic) {
    const std::vector<std::size_t> lidars = lidar_topics();
    for (std::size_t i = 0; i < lidars.size(); ++i) {
      if (&topics_[lidars[i]] == &topic) return packets_[i];
    }
    return packets_.front();
  }

  void mount(const OpenOptions& options) {
    for (const std::size_t topic : lidar_topics()) {
      topics_[topic].packets ? learn_from_packets(topic, options) : learn_lidar(topic, options);
    }
    const auto frame_of = [&](const std::optional<std::size_t>& topic) {
      return topic ? topics_[*topic].frame : std::string();
    };
    BagMounting mounting(frames_, statements_, frame_of(chosen_.lidar), frame_of(chosen_.imu),
                         info_);
    const auto add = [&](const std::optional<std::size_t>& topic, SensorKind kind) {
      if (!topic) return;
      const PeekedTopic& peeked = topics_[*topic];
      std::string label = peeked.topic;
      if (info_.rig.find(label) != nullptr) label += fmt::format(" ({})", name_of(kind));
      labels_[*topic] = label;
      const geometry::Pose3 T_body_sensor = peeked.kind == TopicKind::kImuPackets
                                                ? place_ouster_imu(peeked)
                                                : mounting.place(kind, peeked);
      info_.rig.sensors.push_back({label, kind, T_body_sensor, std::nullopt});
      apply_vehicle(statements_, info_.rig.sensors.back());
      if (peeked.wheels) measure_wheels(peeked, info_.rig.sensors.back());
      if (kind == SensorKind::kLidar) {
        ProfileChoice& choice = lidars_.at(*topic).profile;
        if (choice.profile.name == sensors::LidarProfile().name) choice.profile.name = label;
        info_.rig.sensors.back().lidar = choice.profile;
        add_profile_facts(choice, statements_, prefix_of(*topic), info_.facts);
        if (!peeked.packets && topic == chosen_.lidar) {
          info_.expected_scans = static_cast<std::size_t>(peeked.count);
        }
      }
      if (!peeked.has_stamps) {
        info_.facts.push_back(
            {"stamps of " + peeked.topic, "log times", "those of its headers are zero"});
      }
    };
    for (const std::size_t topic : lidar_topics()) add(topic, SensorKind::kLidar);
    add(chosen_.imu, SensorKind::kImu);
    add(chosen_.gnss, SensorKind::kGnss);
    add(chosen_.wheels, SensorKind::kWheels);
    add(chosen_.laser, SensorKind::kPlanarLaser);
  }

  /// Says what the pulses of wheels are whose angles are known.
  void measure_wheels(const PeekedTopic& topic, sensors::MountedSensor& wheels) {
    const double radius_m = statements_->wheel_joints.radius_m;
    std::string reason = "vehicle.wheels.left_m_per_pulse, right_m_per_pulse are stated";
    if (!wheels.encoder && radius_m > 0) {
      wheels.encoder = {radius_m / kPulsesPerRadian, radius_m / kPulsesPerRadian};
      reason = fmt::format("wheels.radius_m={:g}, {}", radius_m,
                           statements_.origin("wheels.radius_m").value_or(""));
    } else if (!wheels.encoder) {
      reason = "wheels.radius_m states how far a radian is; until then it is not known";
    }
    info_.facts.push_back({"pulses of " + topic.topic,
                           fmt::format("{:g} a radian of {} (left) and {} (right)",
                                       kPulsesPerRadian, topic.wheels->left, topic.wheels->right),
                           reason});
  }

  /// Tells one lidar's facts from another's.
  std::string prefix_of(std::size_t lidar) const {
    return lidar == chosen_.lidar ? "" : topics_[lidar].topic + ": ";
  }

  void learn_from_packets(std::size_t topic, const OpenOptions& options) {
    const PacketTopic& found = *topics_[topic].packets;
    const packets::PacketLidar& lidar = found.lidar;
    lidars_[topic].profile = choose_profile(
        statements_, options.share_folder,
        {lidar.profile, fmt::format("by its packets: {} {}", lidar.maker, lidar.model)});
    note_idle_point_statements(statements_, prefix_of(topic), kPacketsTellAll, info_.facts);
    info_.facts.push_back(clock_fact(found.has_absolute_clock, prefix_of(topic)));
  }

  /// It is in one housing with the lidar whose topic is taken, as far as that is an Ouster's.
  geometry::Pose3 place_ouster_imu(const PeekedTopic& topic) {
    const bool is_in_lidar = chosen_.lidar && topics_[*chosen_.lidar].packets &&
                             topics_[*chosen_.lidar].packets->lidar.maker == "Ouster";
    const geometry::Pose3 T_lidar_imu = ouster_imu_mounting(ouster_->metadata);
    const Eigen::Vector3d& t = T_lidar_imu.translation;
    info_.facts.push_back(
        {fmt::format("mounting of {}", topic.topic),
         fmt::format("{:.4f} {:.4f} {:.4f} m in {}", t.x(), t.y(), t.z(),
                     is_in_lidar ? "the lidar" : "an Ouster that is taken to be the body"),
         "Ouster metadata"});
    return is_in_lidar ? info_.rig.first(SensorKind::kLidar)->T_body_sensor * T_lidar_imu
                       : T_lidar_imu;
  }

  /// What the first scans tell of the lidar and of its points' fields.
  void learn_lidar(std::size_t index, const OpenOptions& options) {
    const PeekedTopic& topic = topics_[index];
    PointFields& fields = lidars_[index].fields;
    container_->begin({topic.channel});
    // Their points stay where they are: the bytes are kept as long as they are looked at.
    std::vector<std::vector<std::byte>> kept;
    std::vector<PointSample> samples;
    std::vector<PointSample> with_one_time;
    std::vector<Stamp> stamps;
    for (std::size_t scans = 0; scans < kExampleScans; ++scans) {
      const auto message = container_->next();
      if (!message) break;
      kept.emplace_back(message->bytes.begin(), message->bytes.end());
      try {
        const bags::MessageValue value = topic.reader->read(kept.back());
        const Stamp stamp = header_stamp(value).value_or(Stamp{message->log_time_ns});
        PointSample sample{columns_of(topic.type, value), stamp};
        stamps.push_back(stamp);
        if (sample.points.points == 0) continue;
        (has_one_time(sample.points) ? with_one_time : samples).push_back(std::move(sample));
      } catch (const bags::BadMessage&) {
        continue;  // counted when the recording is read
      } catch (const UnusableMessage&) {
        continue;
      }
    }
    if (samples.empty()) samples = std::move(with_one_time);
    ProfileChoice from_data;
    from_data.reason = "default; from the first scans";
    from_data.profile.time_source = sensors::TimeSource::kNone;
    if (!samples.empty()) {
      fields = interpret(samples, stamps, prefix_of(index));
      const PointSample& example = samples.back();
      if (fields.time) from_data.profile.time_source = sensors::TimeSource::kData;
      PointFields without_times = fields;
      without_times.time.reset();
      without_times.needs_rings = false;
      const auto scan = scan_of_columns(example.points, example.stamp, without_times, path_);
      if (scan.ring.empty()) {
        from_data.reason += ", which have no ring number";
      } else {
        from_data.profile.rings = *std::max_element(scan.ring.begin(), scan.ring.end()) + 1;
      }
      from_data.profile.intensity_full_scale = full_scale(example.points, fields, scan.intensity);
    }
    lidars_[index].profile = choose_profile(statements_, options.share_folder, from_data);
    const sensors::LidarProfile& profile = lidars_[index].profile.profile;
    fields.needs_rings = profile.ring_source == sensors::RingSource::kData;
    // Points that are moved already need no times; they are kept where somebody says what they are.
    const bool is_of_no_use = info_.motion_compensated && !statements_.states("lidar.time_unit");
    if (is_of_no_use || profile.time_source != sensors::TimeSource::kData) {
      fields.time.reset();
    }
  }

  static double full_scale(const PointColumns& points, const PointFields& fields,
                           const std::vector<float>& intensity) {
    const PointColumn* column = points.find(fields.intensity);
    if (column == nullptr || intensity.empty()) return sensors::LidarProfile().intensity_full_scale;
    if (column->type == ScalarType::kUint16) return 65535;
    if (column->type == ScalarType::kUint8) return 255;
    return *std::max_element(intensity.begin(), intensity.end()) <= 1 ? 1 : 255;
  }

  PointFields interpret(const std::vector<PointSample>& samples, const std::vector<Stamp>& stamps,
                        const std::string& prefix) {
    PointFieldHints hints = stated_point_fields(statements_);
    std::vector<double> intervals;
    for (std::size_t i = 1; i < stamps.size(); ++i) {
      intervals.push_back(geometry::seconds_between(stamps[i - 1], stamps[i]));
    }
    const double interval = intervals.empty() ? 0 : statistics::median(intervals);
    if (interval > 0) hints.scan_interval_s = interval;
    hints.recording = path_;
    std::vector<Fact> facts;
    PointFields fields = interpret_points(samples, hints, facts);
    for (Fact& fact : facts) {
      fact.name = prefix + fact.name;
      info_.facts.push_back(std::move(fact));
    }
    return fields;
  }

  void read_reference(const OpenOptions& options, const sensors::MountedSensor* lidar) {
    const geometry::Pose3 T_body_lidar =
        lidar != nullptr ? lidar->T_body_sensor : geometry::Pose3::identity();
    if (const auto file = stated_reference(statements_)) {
      reference_ = load_reference(*file, {T_body_lidar, info_.T_body_camera}, {}, info_.facts);
      return;
    }
    if (!options.wants_reference || !chosen_.reference) return;
    reference_ = reference_of_topic(*container_, topics_[*chosen_.reference], frames_, T_body_lidar,
                                    statements_, info_);
  }

  void read_message() {
    const auto message = container_->next();
    if (!message) {
      if (takes_packets()) {
        const std::string place = "the end";
        for (PacketsOfTopic& packets : packets_) {
          packets.lidars.finish(packets_to(place));
          packets.tally.tell(packets.lidars, place, queue_.skipped());
          note_packets(packets.lidars, info_.facts);
        }
      }
      queue_.finish();
      queue_.note_steps(info_.facts);
      for (const auto& [reason, loss] : container_->losses().by_reason()) {
        for (std::size_t i = 0; i < loss.count; ++i) {
          queue_.skipped().add(reason,
                               loss.first_places[std::min(i, loss.first_places.size() - 1)]);
        }
      }
      return;
    }
    const auto known = std::find_if(labels_.begin(), labels_.end(), [&](const auto& label) {
      return topics_[label.first].channel == message->channel;
    });
    const PeekedTopic* found =
        known == labels_.end() ? companion(message->channel) : &topics_[known->first];
    if (found == nullptr) return;
    const PeekedTopic& topic = *found;
    const auto place = [&] {
      return fmt::format("{}, log time {}", topic.topic, to_text(Stamp{message->log_time_ns}));
    };
    try {
      if (known == labels_.end()) {
        hear_companion(topic, *message, place());
        return;
      }
      if (holds_packets(topic)) {
        add_packets(topic, *message, place());
      } else if (auto measurement = measurement_of(topic, known->second, *message)) {
        queue_.push(std::move(*measurement), place());
        queue_.note_steps(info_.facts);
      }
    } catch (const bags::BadMessage& error) {
      queue_.skipped().add(error.what(), place());
    } catch (const UnusableMessage& error) {
      queue_.skipped().add(error.what(), place());
    } catch (const InputError& error) {  // of a cloud whose fields are others than before
      queue_.skipped().add(fmt::format("expected {}, found {}", error.expected(), error.found()),
                           place());
    }
  }

  const PeekedTopic* companion(std::size_t channel) const {
    for (const auto& beside : {chosen_.headings, chosen_.pulses}) {
      if (beside && topics_[*beside].channel == channel) return &topics_[*beside];
    }
    return nullptr;
  }

  /// Keeps what a message beside that of a sensor tells until this comes.
  void hear_companion(const PeekedTopic& topic, const bags::Message& message,
                      const std::string& place) {
    const bags::MessageValue value = topic.reader->read(message.bytes);
    const Stamp stamp = header_stamp(value).value_or(Stamp{message.log_time_ns});
    if (topic.kind == TopicKind::kHeading) {
      if (beside_.heading_deg)
        queue_.skipped().add("heading without a fix of its stamp behind it", place);
      beside_.heading_deg = {stamp, heading_deg_of(value)};
    } else {
      if (beside_.pulses)
        queue_.skipped().add("pulses without odometry of their stamp behind them", place);
      beside_.pulses = {stamp, pulses_of(value)};
    }
  }

  void add_packets(const PeekedTopic& topic, const bags::Message& message,
                   const std::string& place) {
    const bags::MessageValue value = topic.reader->read(message.bytes);
    const packets::PacketLidars::Sink sink = packets_to(place);
    PacketsOfTopic& of_topic = packets_of(topic);
    for_each_packet(value, Stamp{message.log_time_ns}, [&](packets::Bytes packet, Stamp arrival) {
      of_topic.lidars.add(topic.topic, packet, arrival, sink);
    });
    of_topic.tally.tell(of_topic.lidars, place, queue_.skipped());
    queue_.note_steps(info_.facts);
  }

  /// What packets give, with the labels of their topics. \param place must outlive it
  packets::PacketLidars::Sink packets_to(const std::string& place) {
    return [this, &place](packets::PacketMeasurement&& found) {
      Measurement& measurement = found.measurement;
      if (std::holds_alternative<sensors::GnssFix>(measurement)) {
        queue_.skipped().add("fix of a position packet, which a bag's lidar does not give", place);
        return;
      }
      if (auto* sample = std::get_if<sensors::ImuSample>(&measurement)) {
        const bool is_taken = chosen_.imu && topics_[*chosen_.imu].kind == TopicKind::kImuPackets;
        if (!is_taken) {
          queue_.skipped().add("reading of an Ouster's IMU among the packets of its returns",
                               place);
          return;
        }
        sample->sensor = labels_.at(*chosen_.imu);
        if (!stated_.apply(*sample)) {
          queue_.skipped().add("increment before which there is no reading", place);
          return;
        }
      }
      queue_.push(std::move(measurement), place);
    };
  }

  const PointFields& fields_of(const PeekedTopic& topic) const {
    return lidars_.at(static_cast<std::size_t>(&topic - topics_.data())).fields;
  }

  std::optional<Measurement> measurement_of(const PeekedTopic& topic, const std::string& label,
                                            const bags::Message& message) {
    const bags::MessageValue value = topic.reader->read(message.bytes);
    const Stamp stamp = header_stamp(value).value_or(Stamp{message.log_time_ns});
    switch (topic.kind) {
      case TopicKind::kCloud: {
        const PointColumns points = columns_of(topic.type, value);
        if (points.points == 0) throw UnusableMessage("scan without points");
        auto scan = in_metres(scan_of_columns(points, stamp, fields_of(topic), path_),
                              statements_->point_unit_m);
        scan.sensor = label;
        return std::make_shared<const sensors::LidarScan>(std::move(scan));
      }
      case TopicKind::kImu: {
        sensors::ImuSample sample = imu_sample_of(value);
        sample.stamp = stamp;
        sample.sensor = label;
        if (!stated_.apply(sample)) {
          throw UnusableMessage("increment before which there is no reading");
        }
        return sample;
      }
      case TopicKind::kGnss: {
        const std::optional<double> heading_deg = take_of(beside_.heading_deg, stamp);
        sensors::GnssFix fix = gnss_fix_of(topic.type, value);
        if (heading_deg) fix.heading_deg = heading_deg;
        fix.stamp = stamp;
        fix.sensor = label;
        stated_.apply(fix);
        if (is_nowhere(fix)) throw UnusableMessage(kNoFixYet);
        const bool is_by_quality = topic.type == "nmea_msgs/Sentence" && fix.covariance_enu;
        if (is_by_quality) note_gga_quality(*fix.covariance_enu, info_.facts);
        return fix;
      }
      case TopicKind::kOdometry:
      case TopicKind::kTwist: {
        const auto pulses = take_of(beside_.pulses, stamp);
        sensors::WheelOdometry odometry = wheel_odometry_of(topic.kind, value);
        odometry.ticks = pulses;
        odometry.stamp = stamp;
        odometry.sensor = label;
        return odometry;
      }
      case TopicKind::kJoints: {
        sensors::WheelOdometry odometry = wheel_angles_of(value, *topic.wheels);
        odometry.stamp = stamp;
        odometry.sensor = label;
        return odometry;
      }
      case TopicKind::kPlanar: {
        sensors::PlanarScan scan = planar_scan_of(value);
        scan.stamp = stamp;
        scan.sensor = label;
        return std::make_shared<const sensors::PlanarScan>(std::move(scan));
      }
      default:
        return std::nullopt;
    }
  }

  fs::path path_;
  Statements statements_;
  RecordingInfo info_;
  std::unique_ptr<bags::MessageContainer> container_;
  std::vector<PeekedTopic> topics_;
  FrameTree frames_;
  ChosenTopics chosen_;
  std::map<std::size_t, std::string> labels_;  ///< of the sensors, by topic
  std::map<std::size_t, BagLidar> lidars_;     ///< by topic
  std::optional<OusterChoice> ouster_;
  std::optional<Reference> reference_;

  StatedMeasurements stated_;
  std::vector<PacketsOfTopic> packets_;  ///< of each lidar, in the order of lidar_topics()
  ArrivalQueue queue_;
  CompanionReadings beside_;
};

}  // namespace

std::unique_ptr<Source> open_bag(const fs::path& path, const OpenOptions& options,
                                 std::string_view format) {
  return std::make_unique<BagSource>(path, options, format);
}

}  // namespace traverse::dataset
