#include <algorithm>
#include <array>
#include <map>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"

#include "byte_cursor.hpp"
#include "chunked_container.hpp"
#include "message_type_name.hpp"

namespace traverse::bags {

using files::InputError;
using files::Place;

namespace {

constexpr std::string_view kMagic = "#ROSBAG V2.0\n";
constexpr std::string_view kAnyMagic = "#ROSBAG V";
constexpr std::uint64_t kLongestHeader = 1 << 20;

enum Op : std::uint8_t {
  kMessageData = 2,
  kBagHeader = 3,
  kIndexData = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7
};

/// The fields "name=value" of a record's header.
class BagFields {
 public:
  /// \throws CutShort
  explicit BagFields(std::span<const std::byte> header) {
    ByteCursor cursor(header);
    while (cursor.left() > 0) {
      const std::string_view field = cursor.text();
      const std::size_t equals = field.find('=');
      if (equals == std::string_view::npos) throw CutShort();
      fields_.emplace_back(field.substr(0, equals), field.substr(equals + 1));
      if (fields_.size() > kMost) throw CutShort();
    }
  }

  std::string_view text(std::string_view name) const {
    for (const auto& [key, value] : fields_) {
      if (key == name) return value;
    }
    return {};
  }
  /// \throws CutShort if it is not there or not as long
  template <typename Number>
  Number number(std::string_view name) const {
    const std::string_view value = text(name);
    if (value.size() != sizeof(Number)) throw CutShort();
    Number number;
    std::memcpy(&number, value.data(), sizeof number);
    return number;
  }
  std::uint8_t op() const { return number<std::uint8_t>("op"); }
  /// Whole seconds and nanoseconds, four bytes each.
  std::int64_t time_ns(std::string_view name) const {
    const auto value = number<std::uint64_t>(name);
    return static_cast<std::int64_t>(value & 0xffffffffU) * 1'000'000'000 +
           static_cast<std::int64_t>(value >> 32U);
  }

 private:
  static constexpr std::size_t kMost = 1000;
  std::vector<std::pair<std::string_view, std::string_view>> fields_;
};

/// A record: its header's fields and its data, of which there may be less than stated.
struct BagRecord {
  std::vector<std::byte> header;
  std::uint64_t data_position = 0;
  std::uint32_t data_size = 0;
  std::uint64_t end() const { return data_position + data_size; }
};

class Ros1Bag : public ChunkedContainer {
 public:
  explicit Ros1Bag(const std::filesystem::path& file) : ChunkedContainer(file) {
    const auto header = read_record(kMagic.size());
    if (!header) throw damaged("a bag's header record", "a file that ends before");
    std::uint64_t index = 0;
    std::uint32_t connections = 0;
    std::uint32_t chunks = 0;
    try {
      const BagFields fields(header->header);
      if (fields.op() != kBagHeader) throw CutShort();
      index = fields.number<std::uint64_t>("index_pos");
      connections = fields.number<std::uint32_t>("conn_count");
      chunks = fields.number<std::uint32_t>("chunk_count");
      if (!fields.text("encryptor").empty()) {
        throw InputError(file_.path(), Place::whole_file(), "a bag that is not encrypted",
                         fmt::format("one encrypted by {}; `rosbag decrypt` makes one that can be "
                                     "read",
                                     files::in_quotes(fields.text("encryptor"))));
      }
    } catch (const CutShort&) {
      throw damaged("a bag's header record", "another");
    }
    const std::uint64_t begin = header->end();
    if (index > 0 && index < file_.size() && read_index(index, connections, chunks)) {
      contents_.how = fmt::format("index of {} chunks ({})", chunks_.size(), packings());
    } else {
      contents_.channels.clear();
      channel_of_.clear();
      chunks_.clear();
      look_through(begin);
      if (index >= file_.size()) {
        losses_.add("the file is cut short: its index and what stood before it is lost",
                    fmt::format("byte {} of {}", file_.size(), index));
      }
      contents_.how =
          fmt::format("no index: {} chunks ({}) were looked through, as `rosbag reindex` does",
                      chunks_.size(), packings());
    }
    finish_opening("a ROS 1 bag");
  }

 protected:
  std::string find_messages(std::span<const std::byte> chunk,
                            std::vector<Found>& messages) override {
    ByteCursor cursor(chunk);
    std::string fault;
    try {
      while (cursor.left() > 0) {
        const BagFields fields(cursor.take(cursor.number<std::uint32_t>()));
        const auto data = cursor.take(cursor.number<std::uint32_t>());
        if (fields.op() != kMessageData) continue;
        const auto channel = channel_of_.find(fields.number<std::uint32_t>("conn"));
        messages.push_back({channel == channel_of_.end() ? kUndescribed : channel->second,
                            fields.time_ns("time"), cursor.at() - data.size(), data.size()});
      }
    } catch (const CutShort&) {
      fault = "a chunk that ends within a record: its rest is lost";
    }
    return fault;
  }
  void find_channels(std::span<const std::byte> chunk) override {
    ByteCursor cursor(chunk);
    try {
      while (cursor.left() > 0) {
        const BagFields fields(cursor.take(cursor.number<std::uint32_t>()));
        const auto data = cursor.take(cursor.number<std::uint32_t>());
        if (fields.op() == kConnection) add_connection(fields, data);
      }
    } catch (const CutShort&) {  // its messages end there too, which is told
    }
  }

 private:
  InputError damaged(const std::string& expected, const std::string& found) const {
    return {file_.path(), Place::whole_file(), expected, found};
  }

  /// The record that begins at `at`; nothing where the file ends within its header.
  std::optional<BagRecord> read_record(std::uint64_t at) {
    BagRecord record;
    const std::vector<std::byte> before = file_.read(at, 4);
    if (before.size() < 4) return std::nullopt;
    const auto length = ByteCursor(before).number<std::uint32_t>();
    if (length > kLongestHeader) return std::nullopt;
    record.header = file_.read(at + 4, length + 4U);
    if (record.header.size() < length + 4U) return std::nullopt;
    record.data_size = ByteCursor(std::span(record.header).subspan(length)).number<std::uint32_t>();
    record.header.resize(length);
    record.data_position = at + 4 + length + 4;
    return record;
  }

  void add_connection(const BagFields& fields, std::span<const std::byte> data) {
    const auto id = fields.number<std::uint32_t>("conn");
    if (channel_of_.contains(id)) return;
    const BagFields described(data);
    Channel channel;
    channel.topic = std::string(fields.text("topic"));
    channel.type = std::string(described.text("type"));
    channel.encoding = "ros1";
    channel.serialization = Serialization::kRos1;
    channel.definition_form = DefinitionForm::kMsg;
    channel.definition = std::string(described.text("message_definition"));
    channel_of_[id] = index_of(std::move(channel));
  }

  void read_connection(const BagRecord& record) {
    const std::vector<std::byte> data = file_.read(record.data_position, record.data_size);
    if (data.size() < record.data_size) throw CutShort();
    add_connection(BagFields(record.header), data);
  }

  /// The index at the end; false if it does not hold what it should.
  bool read_index(std::uint64_t at, std::uint32_t connections, std::uint32_t chunks) {
    try {
      for (std::uint32_t i = 0; i < connections; ++i) {
        const auto record = read_record(at);
        if (!record || BagFields(record->header).op() != kConnection) return false;
        read_connection(*record);
        at = record->end();
      }
      for (std::uint32_t i = 0; i < chunks; ++i) {
        const auto record = read_record(at);
        if (!record) return false;
        const BagFields fields(record->header);
        if (fields.op() != kChunkInfo) return false;
        if (!add_indexed_chunk(fields, *record)) return false;
        at = record->end();
      }
      return true;
    } catch (const CutShort&) {
      return false;
    }
  }

  bool add_indexed_chunk(const BagFields& info, const BagRecord& record) {
    const auto chunk_record = read_record(info.number<std::uint64_t>("chunk_pos"));
    if (!chunk_record || BagFields(chunk_record->header).op() != kChunk) return false;
    Chunk chunk = chunk_from(*chunk_record);
    chunk.first_ns = info.time_ns("start_time");
    chunk.last_ns = info.time_ns("end_time");
    const std::vector<std::byte> counts = file_.read(record.data_position, record.data_size);
    ByteCursor cursor(counts);
    for (auto left = info.number<std::uint32_t>("count"); left > 0; --left) {
      const auto channel = channel_of_.find(cursor.number<std::uint32_t>());
      const auto count = cursor.number<std::uint32_t>();
      if (channel == channel_of_.end()) return false;
      contents_.channels[channel->second].count += count;
      chunk.channels.push_back(channel->second);
    }
    if (!chunk.channels.empty()) chunks_.push_back(std::move(chunk));
    return true;
  }

  /// \throws CutShort, InputError for a packing that is not known
  Chunk chunk_from(const BagRecord& record) const {
    const BagFields fields(record.header);
    Chunk chunk;
    chunk.position = record.data_position;
    chunk.packed = record.data_size;
    chunk.unpacked = fields.number<std::uint32_t>("size");
    const std::string_view name = fields.text("compression");
    const auto packing = packing_named(name);
    if (!packing || *packing == Packing::kZstd) {
      throw InputError(file_.path(), Place{place_of(chunk)}, "compression none, bz2 or lz4",
                       files::in_quotes(name));
    }
    chunk.packing = *packing;
    return chunk;
  }

  /// Reads records from `at` on, as far as the file goes.
  void look_through(std::uint64_t at) {
    try {
      while (at < file_.size()) {
        const auto record = read_record(at);
        if (!record) throw CutShort();
        const BagFields fields(record->header);
        switch (fields.op()) {
          case kChunk:
            look_into(chunk_from(*record));
            break;
          case kConnection:
            read_connection(*record);
            break;
          case kMessageData:
            losses_.add("message outside of chunks", fmt::format("byte {}", at));
            break;
          default:
            break;
        }
        at = record->end();
      }
    } catch (const CutShort&) {
      losses_.add("the file is cut short or damaged: what follows is lost",
                  fmt::format("byte {} of {}", at, file_.size()));
    }
  }

  std::map<std::uint32_t, std::uint32_t> channel_of_;  ///< by connection
};

}  // namespace

bool is_ros1_bag(const std::filesystem::path& file) {
  const auto bytes = first_bytes(file, kAnyMagic.size());
  return ByteCursor::as_text(bytes) == kAnyMagic;
}

std::unique_ptr<MessageContainer> open_ros1_bag(const std::filesystem::path& file) {
  const auto bytes = first_bytes(file, kMagic.size());
  const std::string_view begin = ByteCursor::as_text(bytes);
  if (begin != kMagic) {
    throw InputError(file, Place::whole_file(), "a bag that begins with #ROSBAG V2.0",
                     begin.starts_with(kAnyMagic)
                         ? files::in_quotes(begin.substr(0, begin.find('\n'))) +
                               "; `rosbag fix` makes one of version 2.0"
                         : files::in_quotes(begin));
  }
  return std::make_unique<Ros1Bag>(file);
}

}  // namespace traverse::bags
