#include <algorithm>
#include <array>
#include <limits>
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

constexpr std::string_view kMcapMagic("\x89MCAP0\r\n", 8);
constexpr std::string_view kMcapStart("\x89MCAP", 5);
constexpr std::uint64_t kFooterBytes = 1 + 8 + 20;
constexpr std::uint64_t kRecordHead = 1 + 8;
constexpr std::uint64_t kMessageHead = 2 + 4 + 8 + 8;
constexpr std::uint64_t kLongestSummary = 256 << 20;
constexpr std::uint64_t kLongestDescription = 16 << 20;  // of a schema or a channel
constexpr std::uint64_t kPieceBytes = 4 << 20;           // of messages that stand outside chunks

enum McapOp : std::uint8_t {
  kMcapFooter = 0x02,
  kMcapSchema = 0x03,
  kMcapChannel = 0x04,
  kMcapMessage = 0x05,
  kMcapChunk = 0x06,
  kMcapMessageIndex = 0x07,
  kMcapChunkIndex = 0x08,
  kMcapStatistics = 0x0b,
  kMcapDataEnd = 0x0f
};

struct McapSchema {
  std::string name;
  std::string encoding;
  std::string text;
};

class Mcap : public ChunkedContainer {
 public:
  explicit Mcap(const std::filesystem::path& file) : ChunkedContainer(file) {
    if (read_summary()) {
      contents_.how = fmt::format("index of {} chunks ({})", chunks_.size(), packings());
    } else {
      chunks_.clear();
      contents_.channels.clear();
      channel_at_.clear();
      schemas_.clear();
      look_through();
      contents_.how =
          fmt::format("no index: {} chunks ({}) were looked through", chunks_.size(), packings());
    }
    finish_opening("an MCAP file");
  }

 protected:
  std::string find_messages(std::span<const std::byte> chunk,
                            std::vector<Found>& messages) override {
    return for_each_record(chunk, [&](std::uint8_t op, ByteCursor record, std::size_t offset) {
      if (op != kMcapMessage) return;
      const auto id = record.number<std::uint16_t>();
      record.number<std::uint32_t>();  // its number
      const auto time = static_cast<std::int64_t>(record.number<std::uint64_t>());
      record.number<std::uint64_t>();  // when it was published
      const auto channel = channel_at_.find(id);
      messages.push_back({channel == channel_at_.end() ? kUndescribed : channel->second, time,
                          offset + record.at(), record.left()});
    });
  }
  void find_channels(std::span<const std::byte> chunk) override {
    for_each_record(chunk, [&](std::uint8_t op, ByteCursor record, std::size_t) {
      if (op == kMcapSchema) add_schema(record);
      if (op == kMcapChannel) add_channel(record);
    });
  }

 private:
  /// Calls `use` with the type of each record, its content and where that begins.
  /// \returns what ended it too early
  template <typename Use>
  static std::string for_each_record(std::span<const std::byte> bytes, const Use& use) {
    ByteCursor cursor(bytes);
    try {
      while (cursor.left() > 0) {
        const auto op = cursor.number<std::uint8_t>();
        const auto content = cursor.take(cursor.number<std::uint64_t>());
        use(op, ByteCursor(content), cursor.at() - content.size());
      }
    } catch (const CutShort&) {
      return "a chunk that ends within a record: its rest is lost";
    }
    return {};
  }

  void add_schema(ByteCursor record) {
    const auto id = record.number<std::uint16_t>();
    McapSchema schema;
    schema.name = std::string(record.text());
    schema.encoding = std::string(record.text());
    schema.text = std::string(record.text());
    schemas_.try_emplace(id, std::move(schema));
  }

  void add_channel(ByteCursor record) {
    const auto id = record.number<std::uint16_t>();
    if (channel_at_.contains(id)) return;
    const auto schema = schemas_.find(record.number<std::uint16_t>());
    Channel channel;
    channel.topic = std::string(record.text());
    channel.encoding = std::string(record.text());
    if (channel.encoding == "cdr") channel.serialization = Serialization::kCdr;
    if (channel.encoding == "ros1") channel.serialization = Serialization::kRos1;
    if (schema != schemas_.end()) {
      channel.type = plain_type_name(schema->second.name);
      const std::string& form = schema->second.encoding;
      const bool is_msg = form == "ros1msg" || form == "ros2msg";
      if (is_msg) channel.definition_form = DefinitionForm::kMsg;
      if (form == "ros2idl" || form == "omgidl") channel.definition_form = DefinitionForm::kIdl;
      if (channel.definition_form != DefinitionForm::kNone) {
        channel.definition = schema->second.text;
        if (channel.definition.empty()) channel.definition_form = DefinitionForm::kNone;
      }
    }
    channel_at_[id] = index_of(std::move(channel));
  }

  /// \throws InputError for a packing that is not known
  static Packing packing_of(std::string_view name, const std::filesystem::path& file,
                            std::uint64_t at) {
    const auto packing = packing_named(name);
    if (!packing || *packing == Packing::kBz2) {
      throw InputError(file, Place{fmt::format("chunk at byte {}", at)},
                       "compression none, lz4 or zstd", files::in_quotes(name));
    }
    return *packing;
  }

  /// Channels, counts and chunks from the summary at the end; false if there is none that tells
  /// all.
  bool read_summary() {
    if (file_.size() < kFooterBytes + kMcapMagic.size()) return false;
    const std::uint64_t footer_at = file_.size() - kMcapMagic.size() - kFooterBytes;
    const std::vector<std::byte> footer = file_.read(footer_at, kFooterBytes + kMcapMagic.size());
    ByteCursor cursor(footer);
    if (cursor.number<std::uint8_t>() != kMcapFooter) return false;
    if (cursor.number<std::uint64_t>() != kFooterBytes - kRecordHead) return false;
    const auto begin = cursor.number<std::uint64_t>();
    const auto offsets = cursor.number<std::uint64_t>();
    cursor.number<std::uint32_t>();
    if (ByteCursor::as_text(cursor.take(cursor.left())) != kMcapMagic) return false;
    const std::uint64_t end = offsets > begin ? offsets : footer_at;
    if (begin == 0 || begin >= end || end > footer_at || end - begin > kLongestSummary)
      return false;

    const std::vector<std::byte> summary = file_.read(begin, end - begin);
    std::map<std::uint16_t, std::uint64_t> counts;
    std::uint64_t messages = 0;
    bool has_statistics = false;
    const auto use = [&](std::uint8_t op, ByteCursor record, std::size_t) {
      if (op == kMcapSchema) add_schema(record);
      if (op == kMcapChannel) add_channel(record);
      if (op == kMcapChunkIndex) add_indexed_chunk(record);
      if (op == kMcapStatistics) {
        has_statistics = true;
        messages = record.number<std::uint64_t>();
        record.take(2 + 4 * 4 + 8 + 8);
        ByteCursor list(record.take(record.number<std::uint32_t>()));
        while (list.left() > 0) {
          const auto id = list.number<std::uint16_t>();
          counts[id] = list.number<std::uint64_t>();
        }
      }
    };
    if (!for_each_record(summary, use).empty()) return false;
    if (!has_statistics || channel_at_.empty() || (chunks_.empty() && messages > 0)) return false;
    std::uint64_t counted = 0;
    for (const auto& [id, count] : counts) {
      counted += count;
      const auto channel = channel_at_.find(id);
      if (channel == channel_at_.end()) return false;
      contents_.channels[channel->second].count += count;
    }
    // Of channels by id: now that they are known.
    for (Chunk& chunk : chunks_) {
      for (std::uint32_t& id : chunk.channels) {
        const auto channel = channel_at_.find(static_cast<std::uint16_t>(id));
        if (channel == channel_at_.end()) return false;
        id = channel->second;
      }
    }
    std::erase_if(chunks_, [](const Chunk& chunk) { return chunk.unpacked == 0; });
    return counted == messages;
  }

  void add_indexed_chunk(ByteCursor record) {
    Chunk chunk;
    chunk.first_ns = static_cast<std::int64_t>(record.number<std::uint64_t>());
    chunk.last_ns = static_cast<std::int64_t>(record.number<std::uint64_t>());
    const auto at = record.number<std::uint64_t>();
    const auto length = record.number<std::uint64_t>();
    ByteCursor list(record.take(record.number<std::uint32_t>()));
    while (list.left() > 0) {
      chunk.channels.push_back(list.number<std::uint16_t>());
      list.number<std::uint64_t>();
    }
    record.number<std::uint64_t>();
    const std::string_view packing = record.text();
    chunk.packed = record.number<std::uint64_t>();
    chunk.unpacked = record.number<std::uint64_t>();
    // Its packed bytes are the last of the record.
    if (at > file_.size() || length > file_.size() - at || chunk.packed > length) throw CutShort();
    chunk.position = at + length - chunk.packed;
    chunk.packing = packing_of(packing, file_.path(), at);
    chunks_.push_back(std::move(chunk));
  }

  void look_through() {
    std::uint64_t at = kMcapMagic.size();
    std::vector<std::byte> head;
    std::optional<Chunk> piece;  // of messages outside chunks
    const auto finish_piece = [&] {
      if (piece) look_into(*std::exchange(piece, std::nullopt));
    };
    bool is_over = false;
    try {
      while (!is_over && at < file_.size()) {
        file_.read(at, kRecordHead, head);
        ByteCursor cursor(head);
        const auto op = cursor.number<std::uint8_t>();
        const auto length = cursor.number<std::uint64_t>();
        const std::uint64_t left = file_.size() - at - kRecordHead;
        if (op == 0) throw CutShort();  // those that are not known are to be passed over
        if (op == kMcapMessage) {
          if (length > left) throw CutShort();
          if (!piece) piece.emplace(Chunk{at, 0, 0});
          piece->packed += kRecordHead + length;
          piece->unpacked = piece->packed;
          if (piece->packed > kPieceBytes) finish_piece();
        } else if (op == kMcapSchema || op == kMcapChannel) {
          finish_piece();
          if (length > left || length > kLongestDescription) throw CutShort();
          const std::vector<std::byte> content = file_.read(at + kRecordHead, length);
          op == kMcapSchema ? add_schema(ByteCursor(content)) : add_channel(ByteCursor(content));
        } else if (op == kMcapChunk) {
          finish_piece();
          look_into(chunk_at(at + kRecordHead, length));
        } else if (op == kMcapDataEnd || op == kMcapFooter) {
          is_over = true;
        } else {
          finish_piece();
        }
        if (length > left) {
          if (op != kMcapChunk) throw CutShort();
          break;  // what there is of the chunk has been taken
        }
        at += kRecordHead + length;
      }
      if (!is_over) throw CutShort();
    } catch (const CutShort&) {
      losses_.add("the file is cut short or damaged: what follows is lost",
                  fmt::format("byte {} of {}", at, file_.size()));
    }
    finish_piece();
  }

  /// The chunk whose record's content begins at `at`. \throws CutShort
  Chunk chunk_at(std::uint64_t at, std::uint64_t length) const {
    const std::vector<std::byte> head = file_.read(at, std::min<std::uint64_t>(length, 256));
    ByteCursor cursor(head);
    Chunk chunk;
    cursor.take(8 + 8);
    chunk.unpacked = cursor.number<std::uint64_t>();
    cursor.number<std::uint32_t>();
    chunk.packing = packing_of(cursor.text(), file_.path(), at);
    chunk.packed = cursor.number<std::uint64_t>();
    chunk.position = at + cursor.at();
    if (chunk.packed > length || cursor.at() > length - chunk.packed) throw CutShort();
    return chunk;
  }

  std::map<std::uint16_t, McapSchema> schemas_;
  std::map<std::uint16_t, std::uint32_t> channel_at_;  ///< by id
};

}  // namespace

bool is_mcap(const std::filesystem::path& file) {
  const auto bytes = first_bytes(file, kMcapStart.size());
  return ByteCursor::as_text(bytes) == kMcapStart;
}

std::unique_ptr<MessageContainer> open_mcap(const std::filesystem::path& file) {
  const auto bytes = first_bytes(file, kMcapMagic.size());
  if (ByteCursor::as_text(bytes) != kMcapMagic) {
    throw InputError(file, Place::whole_file(), "an MCAP file of version 0",
                     files::in_quotes(ByteCursor::as_text(bytes)));
  }
  return std::make_unique<Mcap>(file);
}

}  // namespace traverse::bags
