#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bags/made_messages.hpp"

/// Writers of bags for tests, by the formats' descriptions and not by what the readers do.
namespace traverse::testing {

struct MadeMessage {
  std::string topic;
  std::string type;  ///< "sensor_msgs/Imu"
  std::int64_t log_time_ns = 0;
  std::string bytes;
};

struct ChunkOptions {
  std::string packing = "none";       ///< none, bz2, lz4, zstd
  std::size_t messages_a_chunk = 10;  ///< 0: no chunks at all (MCAP)
  bool shuffle = false;               ///< messages are dealt to chunks like cards, chunks reversed
  bool has_index = true;              ///< else as a recorder that was killed leaves it
  bool has_definitions = true;
};

void write_ros1_bag(const std::filesystem::path& file, const std::vector<MadeMessage>& messages,
                    const ChunkOptions& options = {});
/// \param wire of the messages: their definitions are told by it
void write_mcap(const std::filesystem::path& file, const std::vector<MadeMessage>& messages,
                const ChunkOptions& options = {}, Wire wire = Wire::kCdr);

struct DatabaseOptions {
  std::size_t files = 1;
  bool pack_messages = false;    ///< each by zstd
  bool has_definitions = false;  ///< table message_definitions
  bool has_time_index = true;
  bool has_metadata = true;
};
/// A folder with metadata.yaml and NAME_0.db3, NAME_1.db3 ...
void write_ros2_bag(const std::filesystem::path& folder, const std::vector<MadeMessage>& messages,
                    const DatabaseOptions& options = {});

/// `text` packed by bz2, lz4 or zstd.
std::string packed_by(const std::string& packing, const std::string& text);

}  // namespace traverse::testing
