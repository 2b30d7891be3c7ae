#include <algorithm>
#include <array>
#include <limits>

#include "traverse/bags/container_writer.hpp"

#include "chunk_writer.hpp"
#include "record_bytes.hpp"
#include "written_definitions.hpp"

namespace traverse::bags {

namespace {

constexpr std::string_view kWrittenMagic("\x89MCAP0\r\n", 8);

enum WrittenMcapOp : std::uint8_t {
  kWrittenHeader = 0x01,
  kWrittenFooter = 0x02,
  kWrittenSchema = 0x03,
  kWrittenChannel = 0x04,
  kWrittenMessage = 0x05,
  kWrittenChunk = 0x06,
  kWrittenMessageIndex = 0x07,
  kWrittenChunkIndex = 0x08,
  kWrittenStatistics = 0x0b,
  kWrittenMetadata = 0x0c,
  kWrittenMetadataIndex = 0x0d,
  kWrittenSummaryOffset = 0x0e,
  kWrittenDataEnd = 0x0f
};

constexpr std::uint32_t kNoChecksum = 0;  // the specification's "not available"

/// What rosbag2 needs to publish a topic again for those who come late: its enumerators of keep
/// all, reliable and transient local.
constexpr std::string_view kLatchedQos =
    "- history: 3\n  depth: 0\n  reliability: 1\n  durability: 1\n"
    "  deadline:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  lifespan:\n    sec: 9223372036\n    nsec: 854775807\n  liveliness: 1\n"
    "  liveliness_lease_duration:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  avoid_ros_namespace_conventions: false";

/// "sensor_msgs/Imu" as ROS 2 calls it: "sensor_msgs/msg/Imu".
std::string ros2_name(const std::string& type) {
  const auto slash = type.find('/');
  return type.substr(0, slash) + "/msg/" + type.substr(slash + 1);
}

class McapWriter final : public ChunkWriter {
 public:
  McapWriter(std::ostream& stream, ChunkPacking packing,
             const std::vector<std::pair<std::string, std::string>>& notes)
      : ChunkWriter(stream, packing) {
    put(kWrittenMagic);
    put_record(kWrittenHeader, RecordBytes().sized("ros2").sized("traverse").text());
    if (notes.empty()) return;
    RecordBytes pairs;
    for (const auto& [key, value] : notes) pairs.sized(key).sized(value);
    const std::uint64_t begin = at();
    constexpr const char* kName = "recording";
    put_record(kWrittenMetadata, RecordBytes().sized(kName).sized(pairs.text()).text());
    metadata_index_ = RecordBytes().u64(begin).u64(at() - begin).sized(kName).text();
  }

  Wire wire() const override { return Wire::kCdr; }

  std::size_t add_channel(const std::string& topic, const std::string& type,
                          bool is_latched) override {
    if (channels_.size() >= std::numeric_limits<std::uint16_t>::max()) {
      throw std::invalid_argument("more channels than MCAP can number");
    }
    auto schema = std::find(schema_types_.begin(), schema_types_.end(), type);
    if (schema == schema_types_.end()) {
      schema_types_.push_back(type);
      schema = schema_types_.end() - 1;
      schemas_.push_back(record(kWrittenSchema, RecordBytes()
                                                    .u16(schema_types_.size())
                                                    .sized(ros2_name(type))
                                                    .sized("ros2msg")
                                                    .sized(written_definition(type, Wire::kCdr))
                                                    .text()));
    }
    RecordBytes metadata;
    if (is_latched) metadata.sized("offered_qos_profiles").sized(kLatchedQos);
    const auto schema_index = static_cast<std::size_t>(schema - schema_types_.begin());
    channels_.push_back({schema_index,
                         record(kWrittenChannel, RecordBytes()
                                                     .u16(channels_.size())
                                                     .u16(schema_index + 1)
                                                     .sized(topic)
                                                     .sized("cdr")
                                                     .sized(metadata.text())
                                                     .text()),
                         false, 0});
    return channels_.size() - 1;
  }

  void add(std::size_t channel, std::int64_t log_time_ns, std::string_view bytes) override {
    if (log_time_ns < 0) {
      throw std::invalid_argument("a time before 1970, which MCAP cannot tell");
    }
    Channel& known = channels_.at(channel);
    if (!known.is_in_chunks) {
      chunk().content.raw(schemas_[known.schema]).raw(known.record);
      known.is_in_chunks = true;
    }
    const auto time = static_cast<std::uint64_t>(log_time_ns);
    index_for(channel, log_time_ns).u64(time).u64(chunk().content.size());
    constexpr std::size_t kHeadBytes = 22;
    chunk()
        .content.u8(kWrittenMessage)
        .u64(kHeadBytes + bytes.size())
        .u16(channel)
        .number(static_cast<std::uint32_t>(known.count))
        .u64(time)
        .u64(time)
        .raw(bytes);
    ++known.count;
    end_message();
  }

 private:
  struct Channel {
    std::size_t schema = 0;  ///< its place in schemas_
    std::string record;
    bool is_in_chunks = false;
    std::uint64_t count = 0;
  };

  static std::string record(WrittenMcapOp op, std::string_view content) {
    return RecordBytes().u8(op).u64(content.size()).raw(content).text();
  }
  void put_record(WrittenMcapOp op, std::string_view content) { put(record(op, content)); }

  std::string statistics() const {
    std::uint64_t messages = 0;
    RecordBytes by_channel;
    for (std::size_t i = 0; i < channels_.size(); ++i) {
      messages += channels_[i].count;
      by_channel.u16(i).u64(channels_[i].count);
    }
    return RecordBytes()
        .u64(messages)
        .u16(schemas_.size())
        .u32(channels_.size())
        .u32(0)  // attachments
        .u32(metadata_index_.empty() ? 0 : 1)
        .u32(chunks())
        .u64(first_of_all_)
        .u64(last_of_all_)
        .sized(by_channel.text())
        .text();
  }

  void put_chunk(const OpenChunk& full, std::string_view packed) override {
    constexpr std::array<std::string_view, 3> kNames{"", "lz4", "zstd"};
    const std::string_view name = kNames.at(static_cast<std::size_t>(packing()));
    const auto first = static_cast<std::uint64_t>(full.first_ns);
    const auto last = static_cast<std::uint64_t>(full.last_ns);
    const std::uint64_t chunk_at = at();
    const std::string head = RecordBytes()
                                 .u64(first)
                                 .u64(last)
                                 .u64(full.content.size())
                                 .number(kNoChecksum)
                                 .sized(name)
                                 .u64(packed.size())
                                 .text();
    put(RecordBytes().u8(kWrittenChunk).u64(head.size() + packed.size()).text());
    put(head);
    put(packed);
    const std::uint64_t index_at = at();
    RecordBytes offsets;
    for (const auto& [channel, entries] : full.index) {
      offsets.u16(channel).u64(at());
      put_record(kWrittenMessageIndex, RecordBytes().u16(channel).sized(entries.text()).text());
    }
    chunk_indices_.raw(record(kWrittenChunkIndex, RecordBytes()
                                                      .u64(first)
                                                      .u64(last)
                                                      .u64(chunk_at)
                                                      .u64(index_at - chunk_at)
                                                      .sized(offsets.text())
                                                      .u64(at() - index_at)
                                                      .sized(name)
                                                      .u64(packed.size())
                                                      .u64(full.content.size())
                                                      .text()));
    first_of_all_ = chunks() == 0 ? first : std::min(first_of_all_, first);
    last_of_all_ = std::max(last_of_all_, last);
  }

  void put_end() override {
    put_record(kWrittenDataEnd, RecordBytes().number(kNoChecksum).text());
    const std::uint64_t summary_at = at();
    struct Group {
      WrittenMcapOp op;
      std::uint64_t begin;
      std::uint64_t end;
    };
    std::vector<Group> groups;
    const auto put_group = [&](WrittenMcapOp op, const auto& put_all) {
      const std::uint64_t begin = at();
      put_all();
      if (at() > begin) groups.push_back({op, begin, at()});
    };
    put_group(kWrittenSchema, [&] {
      for (const std::string& schema : schemas_) put(schema);
    });
    put_group(kWrittenChannel, [&] {
      for (const Channel& channel : channels_) put(channel.record);
    });
    put_group(kWrittenStatistics, [&] { put_record(kWrittenStatistics, statistics()); });
    put_group(kWrittenChunkIndex, [&] { put(chunk_indices_.text()); });
    put_group(kWrittenMetadataIndex, [&] {
      if (!metadata_index_.empty()) put_record(kWrittenMetadataIndex, metadata_index_);
    });
    const std::uint64_t offsets_at = at();
    for (const Group& group : groups) {
      put_record(kWrittenSummaryOffset,
                 RecordBytes().u8(group.op).u64(group.begin).u64(group.end - group.begin).text());
    }
    put_record(kWrittenFooter,
               RecordBytes().u64(summary_at).u64(offsets_at).number(kNoChecksum).text());
    put(kWrittenMagic);
  }

  std::string metadata_index_;
  std::vector<std::string> schema_types_;
  std::vector<std::string> schemas_;  ///< records
  std::vector<Channel> channels_;
  RecordBytes chunk_indices_;
  std::uint64_t first_of_all_ = 0;
  std::uint64_t last_of_all_ = 0;
};

}  // namespace

std::unique_ptr<ContainerWriter> write_mcap(
    std::ostream& stream, ChunkPacking packing,
    const std::vector<std::pair<std::string, std::string>>& notes) {
  return std::make_unique<McapWriter>(stream, packing, notes);
}

}  // namespace traverse::bags
