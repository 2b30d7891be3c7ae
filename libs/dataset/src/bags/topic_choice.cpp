#include "bags/topic_choice.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/files/input_error.hpp"

#include "bags/companion_topics.hpp"
#include "point_clouds/point_fields.hpp"
#include "point_clouds/point_names.hpp"
#include "recording/lidars_as_one.hpp"

namespace traverse::dataset {

namespace {

// How far is looked for a first message, and how many transforms.
constexpr std::size_t kPeekedMessages = 5000;
constexpr std::uint64_t kPeekedBytes = 64 << 20;
constexpr std::size_t kMostTransforms = 20'000;
constexpr std::size_t kMovingLooked = 2000;
// They stand among everything else, which is unpacked with them: how long they are looked at, and
// how long when they tell nothing new and all sensors are linked.
constexpr std::int64_t kMovingLooked_ns = 10'000'000'000;
constexpr std::int64_t kRepeatedLooked_ns = 2'000'000'000;
constexpr std::size_t kRepeatedStatic = 10;  // messages

bool is_static(const PeekedTopic& topic) { return topic.topic.ends_with("tf_static"); }

/// Frames that are no sensor's: what is told in them has been moved there by somebody.
bool is_world(const std::string& frame) {
  constexpr std::array<std::string_view, 5> kWorlds{"map", "odom", "world", "camera_init", "earth"};
  return std::find(kWorlds.begin(), kWorlds.end(), frame) != kWorlds.end();
}

/// Whether the frames of all sensors that were seen hang together.
bool are_linked(const FrameTree& frames, const std::vector<PeekedTopic>& topics) {
  std::optional<std::string> first;
  for (const PeekedTopic& topic : topics) {
    const bool is_sensor = topic.kind == TopicKind::kCloud || topic.kind == TopicKind::kImu ||
                           topic.kind == TopicKind::kGnss || topic.kind == TopicKind::kPackets;
    if (!is_sensor || !topic.was_seen || topic.frame.empty() || is_world(topic.frame)) continue;
    if (!first) first = topic.frame;
    if (!frames.find(*first, topic.frame)) return false;
  }
  return true;
}

/// Publishers of joints may be several on one topic: an arm's, and the wheels'.
constexpr std::size_t kPeekedJoints = 20;

void look_at_joints(PeekedTopic& topic, const bags::MessageValue& message,
                    const WheelJointStatements& stated) {
  constexpr std::size_t kMostNames = 8;
  std::vector<std::string> names = joints_in(message);
  topic.wheels = wheel_joints_of(names, stated);
  topic.fault.clear();
  if (topic.wheels) {
    wheel_angles_of(message, *topic.wheels);
    return;
  }
  const bool are_more = names.size() > kMostNames;
  names.resize(std::min(names.size(), kMostNames));
  topic.fault = fmt::format(
      "no left and right wheel can be told among its joints ({}{}); wheels.left_joint=... and "
      "wheels.right_joint=... state them",
      fmt::join(names, ", "), are_more ? ", ..." : "");
}

void look_at(PeekedTopic& topic, const bags::MessageValue& message,
             const WheelJointStatements& stated) {
  if (topic.kind == TopicKind::kTransforms) return;
  topic.frame = FrameTree::name_of(header_frame(message));
  const auto stamp = header_stamp(message);
  topic.has_stamps = stamp.has_value();
  switch (topic.kind) {
    case TopicKind::kCloud: {
      const PointColumns points = columns_of(topic.type, message);
      const PointFields coordinates = coordinates_of(points);
      static_cast<void>(
          scan_of_columns(points, stamp.value_or(geometry::Stamp{}), coordinates, ""));
      topic.points = points.points;
      topic.has_rings = !ring_columns(points).empty() || points.rows > 1;
      topic.has_times = !time_columns(points).empty() && !has_one_time(points);
      break;
    }
    case TopicKind::kImu:
      imu_sample_of(message);
      break;
    case TopicKind::kJoints:
      look_at_joints(topic, message, stated);
      break;
    case TopicKind::kPlanar:
      planar_scan_of(message);
      break;
    default:
      break;
  }
}

}  // namespace

std::vector<PeekedTopic> peek_topics(bags::MessageContainer& container,
                                     const WheelJointStatements& wheels) {
  const bags::Contents& contents = container.contents();
  std::vector<PeekedTopic> topics;
  std::vector<std::size_t> looked_for;
  for (std::size_t i = 0; i < contents.channels.size(); ++i) {
    const bags::Channel& channel = contents.channels[i];
    PeekedTopic topic;
    topic.channel = i;
    topic.topic = channel.topic;
    topic.type = channel.type;
    topic.kind = kind_of_type(channel.type);
    topic.count = channel.count;
    const double span_s = 1e-9 * static_cast<double>(contents.last_ns - contents.first_ns);
    if (channel.count > 1 && span_s > 0) {
      topic.rate_hz = static_cast<double>(channel.count - 1) / span_s;
    }
    if (topic.kind != TopicKind::kOther && channel.count > 0) {
      try {
        topic.reader.emplace(bags::definition_of(channel), channel.serialization);
        if (topic.kind != TopicKind::kPackets) looked_for.push_back(i);
      } catch (const bags::BadMessage& error) {
        topic.fault = error.what();
      }
    }
    topics.push_back(std::move(topic));
  }
  container.begin(looked_for);
  std::size_t left = looked_for.size();
  std::vector<std::size_t> looks(topics.size(), 0);
  std::uint64_t bytes = 0;
  for (std::size_t count = 0; left > 0 && count < kPeekedMessages && bytes < kPeekedBytes;
       ++count) {
    const auto message = container.next();
    if (!message) break;
    bytes += message->bytes.size();
    PeekedTopic& topic = topics[message->channel];
    const bool is_over = topic.kind == TopicKind::kJoints
                             ? topic.wheels || looks[message->channel] == kPeekedJoints
                             : topic.was_seen;
    if (is_over) continue;
    if (!topic.was_seen) --left;
    topic.was_seen = true;
    ++looks[message->channel];
    try {
      look_at(topic, topic.reader->read(message->bytes), wheels);
    } catch (const bags::BadMessage& error) {
      topic.fault = error.what();
    } catch (const UnusableMessage& error) {
      topic.fault = error.what();
    } catch (const files::InputError& error) {
      topic.fault = fmt::format("expected {}, found {}", error.expected(), error.found());
    }
  }
  return topics;
}

void peek_packets(bags::MessageContainer& container, const std::optional<OusterChoice>& ouster,
                  std::vector<PeekedTopic>& topics) {
  // An Ouster's driver gives each packet a message of its own.
  constexpr std::size_t kMostMessages = 20;
  for (PeekedTopic& topic : topics) {
    if (topic.kind != TopicKind::kPackets || !topic.reader) continue;
    packets::PacketLidars lidars(ouster ? std::optional(ouster->metadata) : std::nullopt);
    container.begin({topic.channel});
    for (std::size_t count = 0; count < kMostMessages && lidars.lidars().empty(); ++count) {
      const auto message = container.next();
      if (!message) break;
      try {
        const bags::MessageValue value = topic.reader->read(message->bytes);
        if (value.find("header") != nullptr) topic.frame = FrameTree::name_of(header_frame(value));
        for_each_packet(value, geometry::Stamp{message->log_time_ns},
                        [&](packets::Bytes packet, geometry::Stamp arrival) {
                          lidars.add(topic.topic, packet, arrival, [](auto&&) {});
                        });
        topic.was_seen = true;
      } catch (const bags::BadMessage& error) {
        topic.fault = error.what();
      } catch (const UnusableMessage& error) {
        topic.fault = error.what();
      }
    }
    const packets::PacketStatistics& found = lidars.statistics();
    if (!lidars.lidars().empty()) {
      topic.packets = PacketTopic{lidars.lidars().front(), lidars.clock(0).is_absolute()};
      topic.has_times = topic.has_rings = true;
      topic.fault.clear();
    } else if (found.imu > 0) {
      topic.kind = TopicKind::kImuPackets;
      topic.fault.clear();
    } else if (found.of_other_ouster > 0 && ouster) {
      topic.fault = fmt::format("packets of another Ouster than that of {}", ouster->from);
    } else if (found.of_other_ouster > 0) {
      topic.fault =
          "packets of an Ouster without its metadata; `--recording lidar.metadata=FILE` states "
          "them";
    } else if (topic.fault.empty()) {
      topic.fault = fmt::format(
          "{} packets, none of a Velodyne, a Hesai or an Ouster that is known", found.packets);
    }
  }
}

std::optional<OusterChoice> ouster_of_bag(bags::MessageContainer& container,
                                          const std::vector<PeekedTopic>& topics,
                                          const Statements& statements,
                                          const std::filesystem::path& path) {
  if (auto stated = stated_ouster(statements)) return stated;
  const bool has_ouster = std::any_of(topics.begin(), topics.end(), [](const PeekedTopic& topic) {
    return topic.type.ends_with("/PacketMsg") && topic.count > 0;
  });
  if (!has_ouster) return std::nullopt;
  for (const PeekedTopic& topic : topics) {
    if (topic.type != "std_msgs/String" || !topic.topic.ends_with("metadata")) continue;
    container.begin({topic.channel});
    const auto message = container.next();
    if (!message) continue;
    try {
      const bags::Channel& channel = container.contents().channels[topic.channel];
      const bags::MessageReader reader(bags::definition_of(channel), channel.serialization);
      const bags::MessageValue value = reader.read(message->bytes);
      const std::string_view text = value["data"].text();
      if (!packets::is_ouster_metadata(text)) continue;
      return OusterChoice{packets::parse_ouster_metadata(text, path), topic.topic,
                          "a topic of the bag"};
    } catch (const bags::BadMessage&) {
      continue;  // without them the packets are told as an Ouster's without metadata
    }
  }
  return ouster_beside(path);
}

FrameTree read_frames(bags::MessageContainer& container, const std::vector<PeekedTopic>& topics) {
  FrameTree frames;
  for (const bool are_static : {true, false}) {
    std::vector<std::size_t> channels;
    for (const PeekedTopic& topic : topics) {
      if (topic.kind == TopicKind::kTransforms && topic.reader && is_static(topic) == are_static) {
        channels.push_back(topic.channel);
      }
    }
    if (channels.empty()) continue;
    container.begin(channels);
    const std::size_t most = are_static ? kMostTransforms : kMovingLooked;
    std::optional<std::int64_t> first_ns;
    std::int64_t last_new_ns = 0;
    std::size_t repeated = 0;
    for (std::size_t count = 0; count < most; ++count) {
      const auto message = container.next();
      if (!message) break;
      if (!first_ns) first_ns = last_new_ns = message->log_time_ns;
      if (!are_static && message->log_time_ns - *first_ns > kMovingLooked_ns) break;
      const bool is_repeated = are_static ? repeated >= kRepeatedStatic
                                          : message->log_time_ns - last_new_ns > kRepeatedLooked_ns;
      if (is_repeated && are_linked(frames, topics)) break;
      bool is_new = false;
      try {
        for_each_transform(topics[message->channel].reader->read(message->bytes),
                           [&](const std::string& parent, const std::string& child,
                               const geometry::Pose3& T, geometry::Stamp) {
                             const std::string above = FrameTree::name_of(parent);
                             const std::string below = FrameTree::name_of(child);
                             const bool is_news = are_static ? frames.add_static(above, below, T)
                                                             : frames.add_moving(above, below, T);
                             is_new = is_new || is_news;
                           });
      } catch (const std::runtime_error&) {
        continue;  // what it would have linked is told as not linked
      }
      repeated = is_new ? 0 : repeated + 1;
      if (is_new) last_new_ns = message->log_time_ns;
    }
  }
  return frames;
}

namespace {

using Better = std::function<bool(const PeekedTopic&, const PeekedTopic&)>;

struct SensorOfBag {
  const char* key;   ///< of the statement: "lidar.topic"
  const char* name;  ///< of the fact
  std::vector<TopicKind> kinds;
  /// Of a topic that nothing is stated about.
  std::function<std::string(const PeekedTopic&)> why_not;  ///< empty: it can be chosen
  Better is_better;
  std::function<std::string(const PeekedTopic&)> what;  ///< that it has, for the reason
};

std::string stated_topic(const Statements& statements, std::string_view key) {
  if (key == "lidar.topic") return statements->topics.lidar;
  if (key == "imu.topic") return statements->topics.imu;
  if (key == "gnss.topic") return statements->topics.gnss;
  if (key == "wheels.topic") return statements->topics.wheels;
  if (key == "laser.topic") return statements->topics.laser;
  return statements->topics.reference;
}

std::string names_of(const std::vector<PeekedTopic>& topics, const std::vector<TopicKind>& kinds) {
  std::string text;
  for (const PeekedTopic& topic : topics) {
    if (std::count(kinds.begin(), kinds.end(), topic.kind) == 0) continue;
    text += (text.empty() ? "" : ", ") + topic.topic;
  }
  return text.empty() ? "none" : text;
}

std::optional<std::size_t> choose(const SensorOfBag& sensor, const std::vector<PeekedTopic>& topics,
                                  const Statements& statements, RecordingInfo& info) {
  const auto fits = [&](const PeekedTopic& topic) {
    return std::count(sensor.kinds.begin(), sensor.kinds.end(), topic.kind) > 0;
  };
  if (const auto origin = statements.origin(sensor.key)) {
    const std::string stated = stated_topic(statements, sensor.key);
    if (stated == "none") {
      info.facts.push_back({sensor.name, "none", *origin});
      return std::nullopt;
    }
    for (std::size_t i = 0; i < topics.size(); ++i) {
      if (topics[i].topic != stated || !fits(topics[i])) continue;
      if (!topics[i].fault.empty()) {
        throw statements.error(sensor.key, "a topic that can be used",
                               fmt::format("{}: {}", stated, topics[i].fault));
      }
      info.facts.push_back({sensor.name, stated, *origin});
      info.topics[i].use = sensor.name;
      info.topics[i].why = *origin;
      return i;
    }
    throw statements.error(sensor.key, "a topic of " + names_of(topics, sensor.kinds),
                           files::in_quotes(stated));
  }
  std::optional<std::size_t> best;
  std::size_t candidates = 0;
  for (std::size_t i = 0; i < topics.size(); ++i) {
    if (!fits(topics[i]) || topics[i].count == 0) continue;
    const std::string why_not =
        topics[i].fault.empty() ? sensor.why_not(topics[i]) : topics[i].fault;
    if (!why_not.empty()) {
      if (info.topics[i].use.empty() && info.topics[i].why.empty()) info.topics[i].why = why_not;
      continue;
    }
    ++candidates;
    if (!best || sensor.is_better(topics[i], topics[*best])) best = i;
  }
  if (!best) return std::nullopt;
  const std::string reason = candidates == 1
                                 ? "the only one of its kind"
                                 : fmt::format("of {}: {}", candidates, sensor.what(topics[*best]));
  info.facts.push_back({sensor.name, topics[*best].topic,
                        fmt::format("{}; {}=... takes another", reason, sensor.key)});
  info.topics[*best].use = sensor.name;
  info.topics[*best].why = reason;
  for (std::size_t i = 0; i < topics.size(); ++i) {
    const bool is_other = fits(topics[i]) && i != *best && info.topics[i].use.empty();
    if (is_other && info.topics[i].why.empty()) {
      info.topics[i].why = fmt::format("{}={} takes it", sensor.key, topics[i].topic);
      const bool is_another_lidar = sensor.name == std::string_view("lidar") &&
                                    topics[i].frame != topics[*best].frame &&
                                    !is_world(topics[i].frame);
      if (is_another_lidar) {
        info.topics[i].why += fmt::format("; '{}={},{}' takes both as one", kLidarsAsOne,
                                          topics[*best].topic, topics[i].topic);
      }
    }
  }
  return best;
}

/// The topic beside that of a sensor which tells more of it.
std::optional<std::size_t> companion_of(const std::optional<std::size_t>& sensor,
                                        std::string_view suffix, TopicKind kind,
                                        const std::vector<PeekedTopic>& topics,
                                        RecordingInfo& info) {
  if (!sensor) return std::nullopt;
  const std::string name = topics[*sensor].topic + std::string(suffix);
  for (std::size_t i = 0; i < topics.size(); ++i) {
    if (topics[i].topic != name || topics[i].kind != kind || !topics[i].reader) continue;
    info.topics[i].use = info.topics[*sensor].use;
    info.topics[i].why = "beside " + topics[*sensor].topic;
    return i;
  }
  return std::nullopt;
}

/// Takes the topics that are stated to be used as one in place of the one that was chosen.
void choose_lidars_as_one(const std::vector<PeekedTopic>& topics, const Statements& statements,
                          ChosenTopics& chosen, RecordingInfo& info) {
  const auto origin = statements.origin(kLidarsAsOne);
  if (!origin) return;
  const std::vector<std::string> labels = labels_of_lidars(statements->lidars);
  if (labels.empty()) return;
  const std::vector<TopicKind> kinds{TopicKind::kCloud, TopicKind::kPackets};
  if (chosen.lidar) info.topics[*chosen.lidar].use.clear();
  std::vector<std::size_t> indices;
  for (const std::string& label : labels) {
    const auto found = std::find_if(topics.begin(), topics.end(), [&](const PeekedTopic& topic) {
      return topic.topic == label && std::count(kinds.begin(), kinds.end(), topic.kind) > 0;
    });
    const auto index = static_cast<std::size_t>(found - topics.begin());
    if (found == topics.end() || std::count(indices.begin(), indices.end(), index) > 0) {
      throw statements.error(kLidarsAsOne, "different topics of " + names_of(topics, kinds),
                             files::in_quotes(label));
    }
    if (!found->fault.empty()) {
      throw statements.error(kLidarsAsOne, "topics that can be used",
                             fmt::format("{}: {}", label, found->fault));
    }
    indices.push_back(index);
    info.topics[index].use = "lidar";
    info.topics[index].why = *origin;
  }
  for (std::size_t i = 0; i < topics.size(); ++i) {
    const bool is_other = std::count(kinds.begin(), kinds.end(), topics[i].kind) > 0 &&
                          std::count(indices.begin(), indices.end(), i) == 0;
    if (is_other && topics[i].fault.empty()) info.topics[i].why = "it is not among those stated";
  }
  std::erase_if(info.facts, [](const Fact& fact) { return fact.name == "lidar"; });
  chosen.lidar = indices.front();
  chosen.more_lidars.assign(indices.begin() + 1, indices.end());
}

std::string not_seen(const PeekedTopic& topic) {
  return topic.was_seen ? "" : "no message among the first of the bag";
}

}  // namespace

ChosenTopics choose_topics(const std::vector<PeekedTopic>& topics, const FrameTree& frames,
                           const Statements& statements, RecordingInfo& info) {
  info.topics.clear();
  for (const PeekedTopic& topic : topics) {
    TopicInfo listed{topic.topic, topic.type, topic.count, topic.rate_hz, "", ""};
    if (topic.kind == TopicKind::kTransforms) listed.use = "transforms";
    info.topics.push_back(std::move(listed));
  }
  ChosenTopics chosen;
  const auto by_count = [](const PeekedTopic& a, const PeekedTopic& b) {
    return std::tuple(a.count, b.topic.size(), b.topic) >
           std::tuple(b.count, a.topic.size(), a.topic);
  };
  const auto told_count = [](const PeekedTopic& topic) {
    return fmt::format("{} messages, {:.3g} Hz", topic.count, topic.rate_hz);
  };
  chosen.lidar = choose(
      {"lidar.topic",
       "lidar",
       {TopicKind::kCloud, TopicKind::kPackets},
       not_seen,
       [&](const PeekedTopic& a, const PeekedTopic& b) {
         // The driver that made a cloud knew the calibration of the unit.
         const auto rank = [](const PeekedTopic& topic) {
           return std::tuple(!is_world(topic.frame), topic.has_times, topic.has_rings,
                             topic.kind == TopicKind::kCloud, topic.count, topic.points);
         };
         return rank(a) != rank(b) ? rank(a) > rank(b) : by_count(a, b);
       },
       [&](const PeekedTopic& topic) {
         return fmt::format("frame {}, {} point times, {} rings, {}", files::in_quotes(topic.frame),
                            topic.has_times ? "with" : "without",
                            topic.has_rings ? "with" : "without", told_count(topic));
       }},
      topics, statements, info);
  choose_lidars_as_one(topics, statements, chosen, info);
  const std::string lidar_frame = chosen.lidar ? topics[*chosen.lidar].frame : "";
  chosen.imu = choose({"imu.topic",
                       "IMU",
                       {TopicKind::kImu, TopicKind::kImuPackets},
                       not_seen,
                       [&](const PeekedTopic& a, const PeekedTopic& b) {
                         if (a.kind != b.kind) return a.kind == TopicKind::kImu;
                         const bool is_a = frames.find(lidar_frame, a.frame).has_value();
                         const bool is_b = frames.find(lidar_frame, b.frame).has_value();
                         return is_a != is_b ? is_a : by_count(a, b);
                       },
                       [&](const PeekedTopic& topic) {
                         const bool is_linked = frames.find(lidar_frame, topic.frame).has_value();
                         return fmt::format("{}{}", is_linked ? "linked to the lidar, " : "",
                                            told_count(topic));
                       }},
                      topics, statements, info);
  chosen.gnss = choose({"gnss.topic",
                        "GNSS",
                        {TopicKind::kGnss},
                        not_seen,
                        [&](const PeekedTopic& a, const PeekedTopic& b) {
                          const auto rank = [](const PeekedTopic& topic) {
                            return topic.type == "sensor_msgs/NavSatFix" ? 2
                                   : topic.type == "nmea_msgs/Sentence"  ? 0
                                                                         : 1;
                          };
                          return rank(a) != rank(b) ? rank(a) > rank(b) : by_count(a, b);
                        },
                        told_count},
                       topics, statements, info);
  // An odometry may be the answer that is looked for; that of wheels says so in its name.
  chosen.wheels = choose(
      {"wheels.topic",
       "wheels",
       {TopicKind::kOdometry, TopicKind::kTwist, TopicKind::kJoints},
       [](const PeekedTopic& topic) -> std::string {
         if (topic.topic.find("wheel") != std::string::npos || topic.kind == TopicKind::kJoints) {
           return not_seen(topic);
         }
         return fmt::format("nothing says that it comes from wheels; wheels.topic={} takes it",
                            topic.topic);
       },
       [&](const PeekedTopic& a, const PeekedTopic& b) {
         // A speed says how far; angles need the wheels' radius.
         const bool is_a = a.kind != TopicKind::kJoints;
         const bool is_b = b.kind != TopicKind::kJoints;
         return is_a != is_b ? is_a : by_count(a, b);
       },
       told_count},
      topics, statements, info);
  chosen.laser =
      choose({"laser.topic", "2-D laser", {TopicKind::kPlanar}, not_seen, by_count, told_count},
             topics, statements, info);
  chosen.headings = companion_of(chosen.gnss, kHeadingOfTopic, TopicKind::kHeading, topics, info);
  chosen.pulses = companion_of(chosen.wheels, kPulsesOfTopic, TopicKind::kPulses, topics, info);
  chosen.reference = choose({"reference.topic",
                             "reference",
                             {TopicKind::kPose, TopicKind::kOdometry, TopicKind::kTransforms},
                             [](const PeekedTopic& topic) {
                               return topic.kind == TopicKind::kPose
                                          ? fmt::format("reference.topic={} takes it", topic.topic)
                                          : std::string("as stated only");
                             },
                             by_count,
                             told_count},
                            topics, statements, info);
  for (TopicInfo& topic : info.topics) {
    if (!topic.use.empty() || !topic.why.empty()) continue;
    const std::string_view why = why_unused(topic.type);
    topic.why = why.empty() ? "no type that is used" : std::string(why);
  }
  return chosen;
}

}  // namespace traverse::dataset
