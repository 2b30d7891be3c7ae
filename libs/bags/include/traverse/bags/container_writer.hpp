#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <ostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "traverse/bags/message_writer.hpp"

namespace traverse::bags {

/// How the chunks of a container are packed.
enum class ChunkPacking { kNone, kLz4, kZstd };

/// Writes a recording of messages of many topics, in pieces as they come: at most a chunk of about
/// a megabyte, or one message that is larger, is held. Messages need not come in the order of their
/// times. The definition of each type goes into the file.
class ContainerWriter {
 public:
  virtual ~ContainerWriter() = default;

  /// How messages have to be written.
  virtual Wire wire() const = 0;

  /// \param type "sensor_msgs/Imu": one whose definition is known here
  /// \param is_latched for those who come late: /tf_static
  /// \returns the channel's number \throws std::invalid_argument for a type that is not known, or
  /// more channels than the format can number
  virtual std::size_t add_channel(const std::string& topic, const std::string& type,
                                  bool is_latched) = 0;

  /// \param log_time_ns since 1970, not negative \throws NoLibrary if that which packs is missing;
  /// std::invalid_argument for a time or a size that the format cannot hold
  virtual void add(std::size_t channel, std::int64_t log_time_ns, std::string_view bytes) = 0;

  /// Writes the last chunk and the index. What the stream did not take is for its owner to find.
  /// \throws NoLibrary
  virtual void finish() = 0;
};

/// A ROS 1 bag of version 2.0, chunks packed by lz4 or not. The stream must be able to go back to
/// its beginning. Source: wiki.ros.org/Bags/Format/2.0.
/// \throws std::invalid_argument for zstd, which ROS 1 has not
std::unique_ptr<ContainerWriter> write_ros1_bag(std::ostream& stream, ChunkPacking packing);

/// An MCAP file of ROS 2's profile: CDR, definitions in the form ros2msg, message indices, a
/// summary with statistics, chunk indices and the offsets of its groups. Source: mcap.dev/spec,
/// version 0, and its registry of profiles. \param notes key and value of a metadata record named
/// "recording"; empty: none
std::unique_ptr<ContainerWriter> write_mcap(
    std::ostream& stream, ChunkPacking packing,
    const std::vector<std::pair<std::string, std::string>>& notes = {});

}  // namespace traverse::bags
