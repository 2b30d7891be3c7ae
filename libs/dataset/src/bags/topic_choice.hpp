#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "traverse/bags/message_container.hpp"
#include "traverse/bags/message_value.hpp"
#include "traverse/dataset/source.hpp"

#include "bags/frame_tree.hpp"
#include "bags/packet_topics.hpp"
#include "bags/ros_messages.hpp"
#include "bags/wheel_joints.hpp"
#include "captures/ouster_choice.hpp"
#include "recording/statements.hpp"

namespace traverse::dataset {

/// A topic of a bag and what its first message tells of it.
struct PeekedTopic {
  std::size_t channel = 0;
  std::string topic;
  std::string type;
  TopicKind kind = TopicKind::kOther;
  std::uint64_t count = 0;
  double rate_hz = 0;
  std::optional<bags::MessageReader> reader;  ///< of its messages
  bool was_seen = false;
  std::string frame;                   ///< of its header
  bool has_stamps = true;              ///< of their headers: not zero
  std::string fault;                   ///< why it cannot be used; empty: it can
  std::size_t points = 0;              ///< of a cloud
  bool has_times = false;              ///< of its points
  bool has_rings = false;              ///< of its points
  std::optional<PacketTopic> packets;  ///< of kPackets: what they are of
  std::optional<WheelJoints> wheels;   ///< of kJoints
};

/// The topics of a recording that are used, as indices.
struct ChosenTopics {
  std::optional<std::size_t> lidar;
  std::vector<std::size_t> more_lidars;  ///< that are stated to be used as one with it
  std::optional<std::size_t> imu;
  std::optional<std::size_t> gnss;
  std::optional<std::size_t> wheels;
  std::optional<std::size_t> laser;     ///< a 2-D one
  std::optional<std::size_t> headings;  ///< of the receiver, see companion_topics.hpp
  std::optional<std::size_t> pulses;    ///< of the wheels
  std::optional<std::size_t> reference;
};

/// All topics of `container`, looked at as far as the first message of each that could be a
/// sensor's is found soon.
std::vector<PeekedTopic> peek_topics(bags::MessageContainer& container,
                                     const WheelJointStatements& wheels);

/// Looks into the topics of packets for the lidar that each is of, and sets what was seen of them;
/// one of an IMU becomes kImuPackets. \param ouster whose packets may be among them
void peek_packets(bags::MessageContainer& container, const std::optional<OusterChoice>& ouster,
                  std::vector<PeekedTopic>& topics);

/// The metadata of the Ouster whose packets are in the bag: stated, or of a topic called
/// "metadata", or found beside the bag. Nothing without packets that are an Ouster's by their type.
/// \throws files::InputError for metadata that cannot be read
std::optional<OusterChoice> ouster_of_bag(bags::MessageContainer& container,
                                          const std::vector<PeekedTopic>& topics,
                                          const Statements& statements,
                                          const std::filesystem::path& path);

/// What is fixed to what: the static transforms, and where these do not link the sensors, the first
/// of the others.
FrameTree read_frames(bags::MessageContainer& container, const std::vector<PeekedTopic>& topics);

/// Chooses a topic for each kind of sensor, by what is stated or by what was seen, and says in
/// `info`, of every topic, what it is used for and why.
/// \throws files::InputError for a topic that is stated and not there or not of such a type
ChosenTopics choose_topics(const std::vector<PeekedTopic>& topics, const FrameTree& frames,
                           const Statements& statements, RecordingInfo& info);

}  // namespace traverse::dataset
