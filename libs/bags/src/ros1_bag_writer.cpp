#include <initializer_list>

#include "traverse/bags/container_writer.hpp"

#include "chunk_writer.hpp"
#include "record_bytes.hpp"
#include "written_definitions.hpp"

namespace traverse::bags {

namespace {

constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";
constexpr std::size_t kBagHeaderBytes = 4096;  // with its padding, so that it can be written anew

enum PutOp : std::uint8_t {
  kPutMessage = 2,
  kPutHeader = 3,
  kPutIndex = 4,
  kPutChunk = 5,
  kPutChunkInfo = 6,
  kPutConnection = 7
};

std::string bytes_of_u32(std::uint64_t value) { return RecordBytes().u32(value).text(); }

std::string bytes_of_time(std::int64_t ns) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  if (ns < 0) throw std::invalid_argument("a time before 1970, which a bag cannot tell");
  return RecordBytes()
      .u32(static_cast<std::uint64_t>(ns / kSecond))
      .u32(static_cast<std::uint64_t>(ns % kSecond))
      .text();
}

using Fields = std::initializer_list<std::pair<std::string_view, std::string>>;

std::string fields_text(Fields fields) {
  RecordBytes text;
  for (const auto& [name, value] : fields) {
    text.u32(name.size() + 1 + value.size()).raw(name).raw("=").raw(value);
  }
  return text.text();
}

void add_record(RecordBytes& to, Fields fields, std::string_view data) {
  to.sized(fields_text(fields)).sized(data);
}

std::string op_field(PutOp op) { return std::string(1, static_cast<char>(op)); }

class Ros1BagWriter final : public ChunkWriter {
 public:
  Ros1BagWriter(std::ostream& stream, ChunkPacking packing) : ChunkWriter(stream, packing) {
    if (packing == ChunkPacking::kZstd) {
      throw std::invalid_argument("chunks of a ROS 1 bag are packed by lz4 or not at all");
    }
    put(kBagMagic);
    put(header(0));
  }

  Wire wire() const override { return Wire::kRos1; }

  std::size_t add_channel(const std::string& topic, const std::string& type,
                          bool is_latched) override {
    const std::size_t number = connections_.size();
    RecordBytes record;
    add_record(record,
               {{"op", op_field(kPutConnection)}, {"conn", bytes_of_u32(number)}, {"topic", topic}},
               fields_text({{"topic", topic},
                            {"type", type},
                            {"md5sum", std::string(ros1_digest(type))},
                            {"message_definition", written_definition(type, Wire::kRos1)},
                            {"callerid", "/traverse"},
                            {"latching", is_latched ? "1" : "0"}}));
    connections_.push_back({record.text(), false});
    return number;
  }

  void add(std::size_t channel, std::int64_t log_time_ns, std::string_view bytes) override {
    Connection& connection = connections_.at(channel);
    const std::string time = bytes_of_time(log_time_ns);
    if (!connection.is_in_chunks) {
      chunk().content.raw(connection.record);
      connection.is_in_chunks = true;
    }
    index_for(channel, log_time_ns).raw(time).u32(chunk().content.size());
    add_record(chunk().content,
               {{"op", op_field(kPutMessage)}, {"conn", bytes_of_u32(channel)}, {"time", time}},
               bytes);
    end_message();
  }

 private:
  struct Connection {
    std::string record;
    bool is_in_chunks = false;
  };

  std::string header(std::uint64_t index_at) const {
    const std::string fields =
        fields_text({{"op", op_field(kPutHeader)},
                     {"index_pos", RecordBytes().u64(index_at).text()},
                     {"conn_count", bytes_of_u32(index_at == 0 ? 0 : connections_.size())},
                     {"chunk_count", bytes_of_u32(index_at == 0 ? 0 : chunks())}});
    RecordBytes record;
    record.sized(fields);
    return record.sized(std::string(kBagHeaderBytes - 8 - fields.size(), ' ')).text();
  }

  void put_chunk(const OpenChunk& full, std::string_view packed) override {
    RecordBytes head;
    head.sized(fields_text({{"op", op_field(kPutChunk)},
                            {"compression", packing() == ChunkPacking::kLz4 ? "lz4" : "none"},
                            {"size", bytes_of_u32(full.content.size())}}))
        .u32(packed.size());
    RecordBytes counts;
    RecordBytes indices;
    constexpr std::size_t kEntryBytes = 12;
    for (const auto& [number, entries] : full.index) {
      const std::size_t count = entries.size() / kEntryBytes;
      add_record(indices,
                 {{"op", op_field(kPutIndex)},
                  {"ver", bytes_of_u32(1)},
                  {"conn", bytes_of_u32(number)},
                  {"count", bytes_of_u32(count)}},
                 entries.text());
      counts.u32(number).u32(count);
    }
    add_record(infos_,
               {{"op", op_field(kPutChunkInfo)},
                {"ver", bytes_of_u32(1)},
                {"chunk_pos", RecordBytes().u64(at()).text()},
                {"start_time", bytes_of_time(full.first_ns)},
                {"end_time", bytes_of_time(full.last_ns)},
                {"count", bytes_of_u32(full.index.size())}},
               counts.text());
    put(head.text());
    put(packed);
    put(indices.text());
  }

  void put_end() override {
    const std::uint64_t index_at = at();
    for (const Connection& connection : connections_) put(connection.record);
    put(infos_.text());
    put_anew(kBagMagic.size(), header(index_at));
  }

  std::vector<Connection> connections_;
  RecordBytes infos_;  ///< of the chunks that are written
};

}  // namespace

std::unique_ptr<ContainerWriter> write_ros1_bag(std::ostream& stream, ChunkPacking packing) {
  return std::make_unique<Ros1BagWriter>(stream, packing);
}

}  // namespace traverse::bags
