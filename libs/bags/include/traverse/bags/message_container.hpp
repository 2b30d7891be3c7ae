#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace traverse::bags {

/// How the messages of a channel are written.
enum class Serialization { kRos1, kCdr, kOther };
/// The language that a channel's definition is written in: lines "type name" with the types that
/// they use behind them, or OMG IDL.
enum class DefinitionForm { kNone, kMsg, kIdl };

/// Messages of one topic and one type.
struct Channel {
  std::string topic;     ///< "/points"
  std::string type;      ///< "sensor_msgs/PointCloud2": without the "/msg/" of ROS 2
  std::string encoding;  ///< as it is stored: "cdr", "ros1", "json"
  Serialization serialization = Serialization::kOther;
  DefinitionForm definition_form = DefinitionForm::kNone;
  std::string definition;   ///< text; empty where none is stored
  std::uint64_t count = 0;  ///< messages, as the index tells or as were found
};

/// One message as it is stored.
struct Message {
  std::size_t channel = 0;           ///< index into Contents::channels
  std::int64_t log_time_ns = 0;      ///< when it was recorded, since 1970
  std::span<const std::byte> bytes;  ///< until next() or begin() of the container
};

/// What a container is, known when it has been opened.
struct Contents {
  std::vector<Channel> channels;
  std::uint64_t messages = 0;
  std::int64_t first_ns = 0;  ///< log time of the earliest message; both 0 without messages
  std::int64_t last_ns = 0;
  /// How it was found out: "index of 12 chunks (lz4)", "no index: 12 chunks were looked through".
  std::string how;
};

/// What of a container could not be read, by reason.
class Losses {
 public:
  struct Loss {
    std::size_t count = 0;
    std::vector<std::string> first_places;  ///< at most ten
  };
  void add(const std::string& reason, const std::string& place);
  const std::map<std::string, Loss>& by_reason() const { return by_reason_; }

 private:
  std::map<std::string, Loss> by_reason_;
};

/// Where a container stands; each kind knows its own.
class Position {
 public:
  virtual ~Position() = default;
};

/// A recording of messages of many topics in one file, or in several: ROS 1 bags, ROS 2 bags, MCAP.
/// What is read is held against the bytes that are there, never taken from a number in a header.
class MessageContainer {
 public:
  virtual ~MessageContainer() = default;

  virtual const Contents& contents() const = 0;

  /// Starts from the first message. \param channels whose messages next() gives, as indices;
  /// pieces of the file that hold none of them are not read
  virtual void begin(const std::vector<std::size_t>& channels) = 0;

  /// The next message in the order of log times, wherever in the file it stands (of equal times in
  /// the order of the file); nothing at the end.
  virtual std::optional<Message> next() = 0;

  /// Whole since it was opened: what could not be read, also of what was only looked through.
  virtual const Losses& losses() const = 0;

  /// How much next() has been through, 0 to 1.
  virtual double share_read() const = 0;

  /// Where next() stands, and back there.
  virtual std::shared_ptr<const Position> position() const = 0;
  virtual void return_to(const Position& position) = 0;
};

/// Whether the file begins like one, whatever it is called. \throws files::InputError if it cannot
/// be read
bool is_ros1_bag(const std::filesystem::path& file);
bool is_mcap(const std::filesystem::path& file);
bool is_sqlite(const std::filesystem::path& file);

/// A bag of version 2.0, its chunks packed by bz2, lz4 or not. Without an index, as one that was
/// cut off, it is looked through. Source: wiki.ros.org/Bags/Format/2.0. \throws files::InputError
/// if nothing of it can be read
std::unique_ptr<MessageContainer> open_ros1_bag(const std::filesystem::path& file);

/// Chunks packed by lz4, zstd or not, or none; without a summary, or cut off, it is looked through.
/// Source: mcap.dev/spec, version 0.
/// \throws files::InputError if nothing of it can be read
std::unique_ptr<MessageContainer> open_mcap(const std::filesystem::path& file);

/// A database of rosbag2 (tables topics and messages; message_definitions since ROS 2 Iron), whose
/// messages may each be packed by zstd.
/// \throws files::InputError if nothing of it can be read
std::unique_ptr<MessageContainer> open_sqlite_bag(const std::filesystem::path& file);

/// Any of these, by what the file begins with.
/// \throws files::InputError also where it begins like none
std::unique_ptr<MessageContainer> open_container(const std::filesystem::path& file);

/// Several as one, in the order of log times. Channels of equal topic, type and definition are one.
std::unique_ptr<MessageContainer> merge(std::vector<std::unique_ptr<MessageContainer>> parts);

}  // namespace traverse::bags
