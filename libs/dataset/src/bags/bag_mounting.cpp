#include "bags/bag_mounting.hpp"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"

#include "bags/ros_messages.hpp"

namespace traverse::dataset {

using geometry::Pose3;
using geometry::Stamp;
using geometry::Trajectory;
using sensors::SensorKind;

namespace {

std::string consequence_for(SensorKind kind) {
  switch (kind) {
    case SensorKind::kImu:
      return "taken to stand in the body's origin with the body's axes; "
             "vehicle.imu.position_m and vehicle.imu.roll_pitch_yaw_deg state where it is";
    case SensorKind::kGnss:
      return "the antenna is taken to stand in the body's origin; vehicle.gnss.position_m states "
             "where it is";
    case SensorKind::kWheels:
      return "taken to be those of the body; vehicle.wheels.position_m states where they are";
    default:
      return "taken to stand in the body's origin";
  }
}

}  // namespace

BagMounting::BagMounting(const FrameTree& frames, const Statements& statements,
                         const std::string& lidar_frame, const std::string& imu_frame,
                         RecordingInfo& info)
    : frames_(frames), info_(info) {
  const std::string start = lidar_frame.empty() ? imu_frame : lidar_frame;
  std::string reason;
  if (statements.states("body_frame") && frames.has(statements->body_frame)) {
    body_ = statements->body_frame;
    reason = *statements.origin("body_frame");
  } else {
    std::vector<std::string> bases{"base_link", "base_footprint"};
    if (!imu_frame.empty()) bases.push_back(imu_frame);
    bases.emplace_back("imu_link");
    for (const std::string& base : bases) {
      if (!frames.has(base) || !frames.find(base, start)) continue;
      body_ = base;
      reason = fmt::format("{} is linked to it by the transforms", files::in_quotes(start));
      break;
    }
    if (body_.empty()) {
      body_ = start;
      reason = "no transforms link it to base_link, base_footprint or an IMU";
    }
    if (statements.states("body_frame")) return;  // a name and no more
    info_.rig.body_frame = body_.empty() ? "body" : body_;
  }
  for (Fact& fact : info_.facts) {
    if (fact.name == "body frame") fact = {"body frame", info_.rig.body_frame, reason};
  }
}

Pose3 BagMounting::place(SensorKind kind, const PeekedTopic& topic) {
  const std::string name = fmt::format("mounting of {}", topic.topic);
  if (const auto T_body_sensor = frames_.find(body_, topic.frame)) {
    const Eigen::Vector3d& t = T_body_sensor->translation;
    const bool is_moving = frames_.is_by_moving(body_, topic.frame);
    info_.facts.push_back({name,
                           fmt::format("{:.3f} {:.3f} {:.3f} m in {}", t.x(), t.y(), t.z(), body_),
                           topic.frame == body_ ? "its frame is the body"
                           : is_moving ? "transforms that stay the same as far as was looked"
                                       : "static transforms"});
    return *T_body_sensor;
  }
  info_.facts.push_back({name, "not known: " + consequence_for(kind),
                         fmt::format("no transform links {} to {}", files::in_quotes(topic.frame),
                                     files::in_quotes(body_))});
  return Pose3::identity();
}

Reference reference_of_topic(bags::MessageContainer& container, const PeekedTopic& topic,
                             const FrameTree& frames, const Pose3& T_body_lidar,
                             const Statements& statements, RecordingInfo& info) {
  const std::string& body = info.rig.body_frame;
  // Of transforms there are many: those of one child in one parent are a trajectory.
  std::map<std::pair<std::string, std::string>, std::vector<std::pair<Stamp, Pose3>>> found;
  std::size_t unusable = 0;
  container.begin({topic.channel});
  while (const auto message = container.next()) {
    try {
      const bags::MessageValue value = topic.reader->read(message->bytes);
      if (topic.kind == TopicKind::kTransforms) {
        for_each_transform(value, [&](const std::string& parent, const std::string& child,
                                      const Pose3& T, Stamp stamp) {
          const std::string name = FrameTree::name_of(child);
          if (name == body || frames.find(name, body)) {
            found[{FrameTree::name_of(parent), name}].emplace_back(stamp, T);
          }
        });
        continue;
      }
      const bags::MessageValue* child = value.find("child_frame_id");
      const Stamp stamp = header_stamp(value).value_or(Stamp{message->log_time_ns});
      found[{FrameTree::name_of(header_frame(value)),
             child == nullptr ? "" : FrameTree::name_of(child->text())}]
          .emplace_back(stamp, pose_of(value));
    } catch (const std::runtime_error&) {
      ++unusable;
    }
  }
  const auto most = std::max_element(found.begin(), found.end(), [](const auto& a, const auto& b) {
    return a.second.size() < b.second.size();
  });
  if (most == found.end()) {
    throw statements.error("reference.topic", fmt::format("poses of {}", body),
                           fmt::format("none in {}", topic.topic));
  }
  auto& [names, poses] = *most;
  std::stable_sort(poses.begin(), poses.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  Trajectory trajectory;
  for (const auto& [stamp, pose] : poses) {
    if (trajectory.empty() || trajectory.stamps().back() < stamp) trajectory.push_back(stamp, pose);
  }
  std::string description;
  const auto T_child_body = names.second.empty() || statements.states("reference.frame")
                                ? std::nullopt
                                : frames.find(names.second, body);
  if (T_child_body) {
    trajectory = trajectory.transformed_right(*T_child_body);
    description = fmt::format("poses of {} in {}, brought to {} by the transforms", names.second,
                              names.first, body);
  } else if (statements->reference_frame == ReferenceFrame::kLidar) {
    trajectory =
        trajectory.transformed_left(T_body_lidar).transformed_right(T_body_lidar.inverse());
    description = "poses of the lidar, T_body = X T_lidar X^-1 with X = T_body_lidar";
  } else if (statements->reference_frame == ReferenceFrame::kCamera) {
    throw statements.error("reference.frame", "body or lidar for poses of a topic", "camera");
  } else {
    description = fmt::format("poses of {} as they stand, taken for the body's",
                              names.second.empty() ? topic.topic : names.second);
  }
  info.facts.push_back({"reference frame", description,
                        statements.reason("reference.frame", "frames of its messages")});
  if (unusable > 0) {
    info.facts.push_back(
        {"reference, to be checked", fmt::format("{} messages left out", unusable), topic.topic});
  }
  return {std::move(trajectory), info.path, std::move(description), std::nullopt};
}

}  // namespace traverse::dataset
