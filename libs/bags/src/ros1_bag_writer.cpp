#include <algorithm>
#include <initializer_list>
#include <map>

#include "traverse/bags/container_writer.hpp"

#include "chunk_packing.hpp"
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

class Ros1BagWriter final : public ContainerWriter {
 public:
  Ros1BagWriter(std::ostream& stream, ChunkPacking packing) : stream_(stream), packing_(packing) {
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
      content_.raw(connection.record);
      connection.is_in_chunks = true;
    }
    if (index_.empty()) first_ns_ = last_ns_ = log_time_ns;
    first_ns_ = std::min(first_ns_, log_time_ns);
    last_ns_ = std::max(last_ns_, log_time_ns);
    index_[channel].raw(time).u32(content_.size());
    add_record(content_,
               {{"op", op_field(kPutMessage)}, {"conn", bytes_of_u32(channel)}, {"time", time}},
               bytes);
    if (content_.size() >= kChunkBytes) end_chunk();
  }

  void finish() override {
    if (!index_.empty()) end_chunk();
    const std::uint64_t index_at = at_;
    for (const Connection& connection : connections_) put(connection.record);
    put(infos_.text());
    stream_.seekp(static_cast<std::streamoff>(kBagMagic.size()));
    const std::string anew = header(index_at);
    stream_.write(anew.data(), static_cast<std::streamsize>(anew.size()));
    stream_.seekp(0, std::ios::end);
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
                     {"chunk_count", bytes_of_u32(index_at == 0 ? 0 : chunks_)}});
    RecordBytes record;
    record.sized(fields);
    return record.sized(std::string(kBagHeaderBytes - 8 - fields.size(), ' ')).text();
  }

  void put(std::string_view bytes) {
    stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    at_ += bytes.size();
  }

  void end_chunk() {
    pack(packing_, content_.text(), packed_);
    RecordBytes head;
    head.sized(fields_text({{"op", op_field(kPutChunk)},
                            {"compression", packing_ == ChunkPacking::kLz4 ? "lz4" : "none"},
                            {"size", bytes_of_u32(content_.size())}}))
        .u32(packed_.size());
    RecordBytes counts;
    RecordBytes indices;
    constexpr std::size_t kEntryBytes = 12;
    for (const auto& [number, entries] : index_) {
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
                {"chunk_pos", RecordBytes().u64(at_).text()},
                {"start_time", bytes_of_time(first_ns_)},
                {"end_time", bytes_of_time(last_ns_)},
                {"count", bytes_of_u32(index_.size())}},
               counts.text());
    put(head.text());
    put(packed_);
    put(indices.text());
    ++chunks_;
    content_.clear();
    index_.clear();
  }

  std::ostream& stream_;
  ChunkPacking packing_;
  std::uint64_t at_ = 0;
  std::vector<Connection> connections_;
  std::uint64_t chunks_ = 0;
  RecordBytes infos_;  ///< of the chunks that are written

  RecordBytes content_;  ///< of the chunk that is being filled
  std::map<std::size_t, RecordBytes> index_;
  std::int64_t first_ns_ = 0;
  std::int64_t last_ns_ = 0;
  std::string packed_;
};

}  // namespace

std::unique_ptr<ContainerWriter> write_ros1_bag(std::ostream& stream, ChunkPacking packing) {
  return std::make_unique<Ros1BagWriter>(stream, packing);
}

}  // namespace traverse::bags
