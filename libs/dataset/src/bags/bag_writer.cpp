#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "traverse/bags/container_writer.hpp"
#include "traverse/dataset/recording_writer.hpp"
#include "traverse/files/input_error.hpp"

#include "bags/companion_topics.hpp"
#include "bags/ros_messages.hpp"
#include "point_clouds/scan_completion.hpp"
#include "recording/recording_files.hpp"
#include "recording/sidecar.hpp"

namespace traverse::dataset {

using bags::MessageWriter;
using bags::Wire;
using geometry::Pose3;
using geometry::Stamp;
using sensors::GnssFix;
using sensors::ImuSample;
using sensors::LidarScan;
using sensors::PlanarScan;
using sensors::SensorKind;
using sensors::WheelOdometry;

namespace {

namespace fs = std::filesystem;

constexpr std::uint8_t kFieldOfUint16 = 4;  // codes of sensor_msgs/PointField
constexpr std::uint8_t kFieldOfFloat32 = 7;
constexpr double kNotMeasured = -1;  // first number of a covariance, as sensor_msgs/Imu has it

bags::ChunkPacking packing_of(BagPacking packing) {
  switch (packing) {
    case BagPacking::kLz4:
      return bags::ChunkPacking::kLz4;
    case BagPacking::kZstd:
      return bags::ChunkPacking::kZstd;
    case BagPacking::kNone:
      break;
  }
  return bags::ChunkPacking::kNone;
}

/// A name as ROS allows it: "/top_lidar" for "top lidar".
std::string topic_named(const std::string& label) {
  std::string name;
  for (const char c : label) {
    const bool is_allowed =
        std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '/';
    name += is_allowed ? c : '_';
  }
  if (!name.starts_with('/')) name.insert(0, "/");
  if (name.size() == 1 || std::isalpha(static_cast<unsigned char>(name[1])) == 0) {
    name.insert(1, "sensor_");
  }
  return name;
}

/// Points as sensor_msgs/PointCloud2: x, y, z and what else there is, one behind the other.
class CloudPoints {
 public:
  CloudPoints(const LidarScan& scan, const DerivedPointData& derived) : points_(scan.size()) {
    add("x", scan.x);
    add("y", scan.y);
    add("z", scan.z);
    add("intensity", scan.intensity);
    add("time", derived.time);
    add("ring", derived.ring);
    step_ = (step_ + 3) / 4 * 4;
    data_.assign(points_ * step_, '\0');
    for (const Column& column : columns_) {
      for (std::size_t i = 0; i < points_; ++i) {
        std::memcpy(data_.data() + i * step_ + column.offset, column.values + i * column.size,
                    column.size);
      }
    }
    is_dense_ = std::all_of(scan.x.begin(), scan.x.end(), [](float x) { return !std::isnan(x); });
  }

  void write(MessageWriter& message) const {
    message.u32(1).u32(points_).u32(columns_.size());
    for (const Column& column : columns_) {
      message.text(column.name).u32(column.offset).u8(column.type).u32(1);
    }
    message.u8(0).u32(step_).u32(points_ * step_).bytes(data_).u8(is_dense_ ? 1 : 0);
  }

 private:
  struct Column {
    const char* name;
    std::uint8_t type;
    std::size_t size;
    std::size_t offset;
    const char* values;
  };

  template <typename Number>
  void add(const char* name, const std::vector<Number>& values) {
    if (values.size() != points_ || values.empty()) return;
    const std::uint8_t type = sizeof(Number) == 2 ? kFieldOfUint16 : kFieldOfFloat32;
    columns_.push_back(
        {name, type, sizeof(Number), step_, reinterpret_cast<const char*>(values.data())});
    step_ += sizeof(Number);
  }

  std::size_t points_;
  std::vector<Column> columns_;
  std::size_t step_ = 0;
  std::string data_;
  bool is_dense_ = true;
};

void write_pose(MessageWriter& message, const Pose3& pose) {
  const Eigen::Vector3d& t = pose.translation;
  const Eigen::Quaterniond q = pose.quaternion();
  message.all(t.x(), t.y(), t.z()).all(q.x(), q.y(), q.z(), q.w());
}

/// Whether the rotation is the same bits after it was a quaternion.
bool keeps_its_rotation(const Pose3& pose) {
  const Pose3 back = Pose3::from_quaternion(pose.quaternion().normalized(), pose.translation);
  return back.rotation == pose.rotation;
}

class BagWriter final : public RecordingWriter {
 public:
  BagWriter(const fs::path& file, const RecordingInfo& info,
            const std::optional<Reference>& reference, const BagOptions& options)
      : file_(file),
        files_(RecordingFiles::beside(file, options.there)),
        stream_(files_.add_data().stream()),
        info_(info),
        reference_(reference) {
    const bags::ChunkPacking packing = packing_of(options.packing);
    container_ = options.format == BagFormat::kRos1
                     ? bags::write_ros1_bag(stream_, packing)
                     : bags::write_mcap(stream_, packing, {{"name", info.name}});
    wire_ = container_->wire();
  }

  void add(const sensors::Measurement& measurement) override {
    if (stamp_of(measurement).nanoseconds < 0) {
      ++left_out_["records before 1970, which times of ROS cannot tell"];
      return;
    }
    try {
      std::visit([this](const auto& held) { write(held); }, measurement);
    } catch (const files::OutputError&) {
      throw;
    } catch (const std::exception& error) {
      throw files::OutputError(file_, error.what());
    }
    if (!stream_) throw files::OutputError(file_, "not every byte was taken");
  }

  void add_file(const std::string& name, const std::string& text) override {
    files_.write(name, text);
  }

  void commit() override {
    try {
      container_->finish();
    } catch (const std::exception& error) {
      throw files::OutputError(file_, error.what());
    }
    Sidecar sidecar = sidecar_of_whole_rig(info_, reference_, has_rings_, has_times_);
    sidecar.bag =
        BagStatements{first_topic(SensorKind::kLidar),       first_topic(SensorKind::kImu),
                      first_topic(SensorKind::kGnss),        first_topic(SensorKind::kWheels),
                      first_topic(SensorKind::kPlanarLaser), has_times_};
    commit_with_sidecar(sidecar, files_);
  }

 private:
  struct Topic {
    std::string name;
    std::string frame;
    std::optional<std::size_t> channel;    ///< none before the first message
    std::optional<std::size_t> companion;  ///< channel of what its own messages cannot hold
    std::uint32_t messages = 0;
  };

  void write(const std::shared_ptr<const LidarScan>& scan) {
    const auto* sensor = info_.rig.find(scan->sensor);
    const auto profile =
        sensor != nullptr && sensor->lidar ? *sensor->lidar : sensors::LidarProfile();
    const DerivedPointData derived = derive_point_data(*scan, profile);
    has_rings_ = has_rings_ || !derived.ring.empty();
    has_times_ = has_times_ || !derived.time.empty();
    Topic& topic = topic_of(scan->sensor, "sensor_msgs/PointCloud2", scan->stamp);
    MessageWriter message = begin(topic, scan->stamp);
    CloudPoints(*scan, derived).write(message);
    put(topic, scan->stamp, message);
  }

  void write(const std::shared_ptr<const PlanarScan>& scan) {
    Topic& topic = topic_of(scan->sensor, "sensor_msgs/LaserScan", scan->stamp);
    MessageWriter message = begin(topic, scan->stamp);
    const std::size_t count = scan->ranges_m.size();
    const double span = scan->azimuth_step * static_cast<double>(count > 0 ? count - 1 : 0);
    const auto first = static_cast<float>(scan->first_azimuth);
    const auto last = static_cast<float>(scan->first_azimuth + span);
    const auto step = static_cast<float>(scan->azimuth_step);
    const auto longest = static_cast<float>(scan->max_range_m);
    const PlanarAngles back = planar_angles(first, last, step, count);
    if (back.first != scan->first_azimuth || back.step != scan->azimuth_step) {
      ++left_out_["digits of 2-D scans' angles beyond those of a float, by scan"];
    }
    const bool is_beyond = std::any_of(scan->ranges_m.begin(), scan->ranges_m.end(),
                                       [&](float range) { return range > longest || range < 0; });
    if (is_beyond) ++left_out_["2-D scans with ranges beyond their sensor's"];
    message.number(first).number(last).number(step).number(0.0F).number(0.0F).number(0.0F);
    message.number(longest).u32(count);
    for (const float range : scan->ranges_m) message.number(range);
    message.u32(0);
    put(topic, scan->stamp, message);
  }

  void write(const ImuSample& sample) {
    Topic& topic = topic_of(sample.sensor, "sensor_msgs/Imu", sample.stamp);
    MessageWriter message = begin(topic, sample.stamp);
    const Eigen::Vector3d& rate = sample.angular_rate;
    const Eigen::Vector3d& force = sample.specific_force;
    message.all(0, 0, 0, 1).f64(kNotMeasured).zeros(8);  // its orientation
    message.all(rate.x(), rate.y(), rate.z()).zeros(9);
    message.all(force.x(), force.y(), force.z()).zeros(9);
    put(topic, sample.stamp, message);
  }

  void write(const GnssFix& fix) {
    constexpr int kUnknown = 0;
    constexpr int kKnown = 3;
    Topic& topic = topic_of(fix.sensor, "sensor_msgs/NavSatFix", fix.stamp);
    if (fix.heading_deg) {
      MessageWriter heading(wire_);
      heading.header(fix.stamp.nanoseconds, topic.frame, topic.messages).f64(*fix.heading_deg);
      put_beside(topic, bags::kGnssHeadingType, kHeadingOfTopic, fix.stamp, heading);
    }
    MessageWriter message = begin(topic, fix.stamp);
    message.number(std::int8_t{0}).number(std::uint16_t{1});  // a fix, by GPS
    message.all(fix.latitude_deg, fix.longitude_deg, fix.altitude_m);
    const Eigen::Matrix3d covariance =
        fix.covariance_enu.value_or(Eigen::Matrix3d(Eigen::Matrix3d::Zero()));
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) message.f64(covariance(row, column));
    }
    message.u8(fix.covariance_enu ? kKnown : kUnknown);
    put(topic, fix.stamp, message);
  }

  void write(const WheelOdometry& odometry) {
    Topic& topic = topic_of(odometry.sensor, "nav_msgs/Odometry", odometry.stamp);
    if (odometry.ticks) {
      MessageWriter pulses(wire_);
      pulses.header(odometry.stamp.nanoseconds, topic.frame, topic.messages)
          .number(odometry.ticks->left)
          .number(odometry.ticks->right);
      put_beside(topic, bags::kWheelPulsesType, kPulsesOfTopic, odometry.stamp, pulses);
    }
    const Pose3 pose = odometry.T_odom_body.value_or(Pose3::identity());
    if (!keeps_its_rotation(pose)) {
      ++left_out_["last digits of turns of wheel odometry, which quaternions round"];
    }
    MessageWriter message(wire_);
    message.header(odometry.stamp.nanoseconds, "odom", topic.messages++).text(info_.rig.body_frame);
    write_pose(message, pose);
    message.f64(odometry.T_odom_body ? 0 : kNotMeasured).zeros(35);
    const auto velocity = odometry.velocity.value_or(WheelOdometry::Velocity());
    message.all(velocity.forward_mps, velocity.left_mps, 0).all(0, 0, velocity.yaw_rate);
    message.f64(odometry.velocity ? 0 : kNotMeasured).zeros(35);
    put(topic, odometry.stamp, message);
  }

  MessageWriter begin(Topic& topic, Stamp stamp) {
    MessageWriter message(wire_);
    message.header(stamp.nanoseconds, topic.frame, topic.messages++);
    return message;
  }

  void put(const Topic& topic, Stamp stamp, MessageWriter& message) {
    container_->add(topic.channel.value(), stamp.nanoseconds, message.take());
  }

  /// Before the message that it belongs to, so that a reader has it when that comes.
  void put_beside(Topic& topic, std::string_view type, std::string_view suffix, Stamp stamp,
                  MessageWriter& message) {
    if (!topic.companion) {
      topic.companion =
          container_->add_channel(topic.name + std::string(suffix), std::string(type), false);
    }
    container_->add(*topic.companion, stamp.nanoseconds, message.take());
  }

  Topic& topic_of(const std::string& label, const char* type, Stamp stamp) {
    mount(stamp);
    Topic& topic = named(label);
    if (!topic.channel) topic.channel = container_->add_channel(topic.name, type, false);
    return topic;
  }

  Topic& named(const std::string& label) {
    const auto [known, is_new] = topics_.try_emplace(label);
    Topic& topic = known->second;
    if (!is_new) return topic;
    const std::string wanted = topic_named(label);
    topic.name = wanted;
    for (int number = 2; !names_.insert(topic.name).second; ++number) {
      topic.name = wanted + "_" + std::to_string(number);
    }
    topic.frame = topic.name.substr(1);
    if (topic.frame == info_.rig.body_frame) topic.frame += "_sensor";
    return topic;
  }

  /// Tells the mountings of the sensors that have come since it was called last: the rig of a
  /// rawlog grows while it is read.
  void mount(Stamp stamp) {
    std::vector<const sensors::MountedSensor*> late;
    for (; mounted_ < info_.rig.sensors.size(); ++mounted_) {
      const auto& sensor = info_.rig.sensors[mounted_];
      if (sensor.kind != SensorKind::kWheels) late.push_back(&sensor);
    }
    if (late.empty()) return;
    if (!transforms_) {
      transforms_ = container_->add_channel("/tf_static", "tf2_msgs/TFMessage", true);
    }
    MessageWriter message(wire_);
    message.u32(late.size());
    for (const auto* sensor : late) {
      message.header(stamp.nanoseconds, info_.rig.body_frame).text(named(sensor->label).frame);
      write_pose(message, sensor->T_body_sensor);
    }
    container_->add(*transforms_, stamp.nanoseconds, message.take());
  }

  std::string first_topic(SensorKind kind) const {
    for (const auto& sensor : info_.rig.sensors) {
      const auto known = topics_.find(sensor.label);
      if (sensor.kind == kind && known != topics_.end() && known->second.channel)
        return known->second.name;
    }
    return {};
  }

  fs::path file_;
  RecordingFiles files_;
  std::ostream& stream_;
  const RecordingInfo& info_;
  const std::optional<Reference> reference_;
  std::unique_ptr<bags::ContainerWriter> container_;
  Wire wire_ = Wire::kRos1;
  std::map<std::string, Topic> topics_;  ///< by label
  std::set<std::string> names_{"/tf_static"};
  std::optional<std::size_t> transforms_;
  std::size_t mounted_ = 0;
  bool has_rings_ = false;
  bool has_times_ = false;
};

}  // namespace

std::unique_ptr<RecordingWriter> write_bag(const fs::path& file, const RecordingInfo& info,
                                           const std::optional<Reference>& reference,
                                           const BagOptions& options) {
  return std::make_unique<BagWriter>(file, info, reference, options);
}

}  // namespace traverse::dataset
