#include "trajectories/pose_topics.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/bags/message_container.hpp"
#include "traverse/bags/message_value.hpp"
#include "traverse/files/input_error.hpp"

#include "bags/bag_files.hpp"
#include "bags/ros_messages.hpp"

namespace traverse::dataset {

namespace {

using bags::MessageValue;
using files::InputError;
using files::Place;
using geometry::Stamp;

constexpr std::array<std::string_view, 5> kPoseTypes{
    "nav_msgs/Odometry", "geometry_msgs/PoseStamped", "geometry_msgs/PoseWithCovarianceStamped",
    "geometry_msgs/TransformStamped", "nav_msgs/Path"};
constexpr std::string_view kPath = "nav_msgs/Path";
constexpr std::string_view kTransform = "geometry_msgs/TransformStamped";

bool holds_poses(const bags::Channel& channel) {
  return channel.count > 0 &&
         std::find(kPoseTypes.begin(), kPoseTypes.end(), channel.type) != kPoseTypes.end();
}

std::string listed(const std::vector<bags::Channel>& channels,
                   const std::function<bool(const bags::Channel&)>& is_listed) {
  std::vector<std::string> names;
  for (const bags::Channel& channel : channels) {
    if (is_listed(channel)) names.push_back(fmt::format("{} ({})", channel.topic, channel.type));
  }
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

std::size_t choose_channel(const std::filesystem::path& file, const std::string& topic,
                           const std::vector<bags::Channel>& channels) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (holds_poses(channels[i]) && (topic.empty() || channels[i].topic == topic)) {
      found.push_back(i);
    }
  }
  if (found.size() == 1) return found.front();
  if (topic.empty()) {
    throw InputError(
        file, Place::whole_file(),
        fmt::format("one topic of {}, or --topic to choose one", fmt::join(kPoseTypes, ", ")),
        listed(channels, holds_poses));
  }
  const auto is_named = [&](const bags::Channel& channel) { return channel.topic == topic; };
  if (std::none_of(channels.begin(), channels.end(), is_named)) {
    throw InputError(file, Place::whole_file(), "the topic " + files::in_quotes(topic),
                     "topics with poses: " + listed(channels, holds_poses));
  }
  throw InputError(file, Place::whole_file(),
                   fmt::format("messages of poses under {}", files::in_quotes(topic)),
                   listed(channels, is_named));
}

/// Poses in the order of their stamps: a topic may tell them late.
class StampedPoses {
 public:
  void add(const MessageValue& message, bool is_transform) {
    const auto stamp = header_stamp(message);
    if (!stamp) throw UnusableMessage("a pose without a stamp");
    poses_.emplace_back(*stamp, is_transform ? transform_of(message) : pose_of(message));
  }
  void clear() { poses_.clear(); }
  void give(const PoseTaker& take) {
    std::stable_sort(poses_.begin(), poses_.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [stamp, pose] : poses_) take(stamp, pose);
  }

 private:
  static geometry::Pose3 transform_of(const MessageValue& message) {
    const MessageValue& transform = message["transform"];
    const MessageValue& t = transform["translation"];
    const MessageValue& q = transform["rotation"];
    return geometry::Pose3::from_quaternion(
        Eigen::Quaterniond(q["w"].number(), q["x"].number(), q["y"].number(), q["z"].number())
            .normalized(),
        {t["x"].number(), t["y"].number(), t["z"].number()});
  }

  std::vector<std::pair<Stamp, geometry::Pose3>> poses_;
};

}  // namespace

void read_pose_topic(const std::filesystem::path& file, const std::string& topic,
                     const PoseTaker& take, TrajectoryReading& reading) {
  std::vector<Fact> facts;
  const auto container = open_bag_files(file, facts);
  const auto& channels = container->contents().channels;
  const std::size_t chosen = choose_channel(file, topic, channels);
  const bags::Channel& channel = channels[chosen];
  const bags::MessageReader messages(bags::definition_of(channel), channel.serialization);
  StampedPoses poses;
  std::size_t number = 0;
  container->begin({chosen});
  while (const auto message = container->next()) {
    try {
      const MessageValue value = messages.read(message->bytes);
      if (channel.type == kPath) {
        poses.clear();  // each tells the whole path once more
        value["poses"].for_each([&](const MessageValue& one) { poses.add(one, false); });
      } else {
        poses.add(value, channel.type == kTransform);
      }
    } catch (const std::runtime_error& error) {
      throw InputError(file, {fmt::format("message {} of {}", number, channel.topic)},
                       "a pose with a stamp", error.what());
    }
    ++number;
  }
  poses.give(take);
  reading.reason += fmt::format(", topic {} ({})", channel.topic, channel.type);
  for (const auto& [reason, loss] : container->losses().by_reason()) {
    reading.notes.push_back(fmt::format("{} of the bag could not be read: {}", loss.count, reason));
  }
  for (const Fact& fact : facts) {
    reading.notes.push_back(fmt::format("{}: {}, {}", fact.name, fact.value, fact.reason));
  }
}

}  // namespace traverse::dataset
