#include "bags/bag_writers.hpp"

#include <algorithm>
#include <bzlib.h>
#include <fstream>
#include <lz4frame.h>
#include <map>
#include <memory>
#include <sqlite3.h>
#include <stdexcept>
#include <zstd.h>

namespace traverse::testing {

namespace {

namespace fs = std::filesystem;

template <typename Number>
std::string little(Number value) {
  std::string raw(sizeof value, '\0');
  std::memcpy(raw.data(), &value, sizeof value);
  return raw;
}
std::string u8(unsigned value) { return little(static_cast<std::uint8_t>(value)); }
std::string u16(std::size_t value) { return little(static_cast<std::uint16_t>(value)); }
std::string u32(std::size_t value) { return little(static_cast<std::uint32_t>(value)); }
std::string u64(std::uint64_t value) { return little(value); }
std::string sized(const std::string& text) { return u32(text.size()) + text; }

/// The messages chunk by chunk.
std::vector<std::vector<const MadeMessage*>> dealt(const std::vector<MadeMessage>& messages,
                                                   const ChunkOptions& options) {
  const std::size_t each = std::max<std::size_t>(options.messages_a_chunk, 1);
  std::vector<std::vector<const MadeMessage*>> chunks((messages.size() + each - 1) / each);
  for (std::size_t i = 0; i < messages.size(); ++i) {
    chunks[options.shuffle ? i % chunks.size() : i / each].push_back(&messages[i]);
  }
  if (options.shuffle) {
    std::reverse(chunks.begin(), chunks.end());
    for (auto& chunk : chunks) std::reverse(chunk.begin(), chunk.end());
  }
  return chunks;
}

/// Topics in the order of their first message, each with a number.
std::map<std::string, std::size_t> numbered(const std::vector<MadeMessage>& messages,
                                            std::vector<const MadeMessage*>& firsts) {
  std::map<std::string, std::size_t> numbers;
  for (const MadeMessage& message : messages) {
    if (numbers.try_emplace(message.topic, firsts.size()).second) firsts.push_back(&message);
  }
  return numbers;
}

std::string ros_time(std::int64_t ns) {
  return u32(static_cast<std::size_t>(ns / 1'000'000'000)) +
         u32(static_cast<std::size_t>(ns % 1'000'000'000));
}

std::string bag_header(const std::vector<std::pair<std::string, std::string>>& fields) {
  std::string text;
  for (const auto& [name, value] : fields) text += sized(name + "=" + value);
  return text;
}

std::string bag_record(const std::vector<std::pair<std::string, std::string>>& fields,
                       const std::string& data) {
  return sized(bag_header(fields)) + sized(data);
}

std::string connection_record(std::size_t number, const MadeMessage& first, bool has_definition) {
  const std::string definition = has_definition ? definition_text(first.type, Wire::kRos1) : "";
  return bag_record({{"op", u8(7)}, {"conn", u32(number)}, {"topic", first.topic}},
                    bag_header({{"topic", first.topic},
                                {"type", first.type},
                                {"md5sum", "*"},
                                {"message_definition", definition}}));
}

std::string mcap_record(unsigned op, const std::string& content) {
  return u8(op) + u64(content.size()) + content;
}

std::string stored_type(const std::string& type, Wire wire) {
  const auto slash = type.find('/');
  return wire == Wire::kRos1 ? type : type.substr(0, slash) + "/msg/" + type.substr(slash + 1);
}

void execute(sqlite3* database, const std::string& text) {
  char* error = nullptr;
  if (sqlite3_exec(database, text.c_str(), nullptr, nullptr, &error) != SQLITE_OK) {
    throw std::runtime_error(error);
  }
}

}  // namespace

std::string packed_by(const std::string& packing, const std::string& text) {
  std::string packed;
  if (packing == "bz2") {
    packed.resize(text.size() + text.size() / 100 + 600);
    auto size = static_cast<unsigned>(packed.size());
    BZ2_bzBuffToBuffCompress(packed.data(), &size, const_cast<char*>(text.data()),
                             static_cast<unsigned>(text.size()), 1, 0, 0);
    packed.resize(size);
  } else if (packing == "lz4") {
    packed.resize(LZ4F_compressFrameBound(text.size(), nullptr));
    packed.resize(
        LZ4F_compressFrame(packed.data(), packed.size(), text.data(), text.size(), nullptr));
  } else if (packing == "zstd") {
    packed.resize(ZSTD_compressBound(text.size()));
    packed.resize(ZSTD_compress(packed.data(), packed.size(), text.data(), text.size(), 1));
  } else {
    packed = text;
  }
  return packed;
}

void write_ros1_bag(const fs::path& file, const std::vector<MadeMessage>& messages,
                    const ChunkOptions& options) {
  std::vector<const MadeMessage*> firsts;
  const auto numbers = numbered(messages, firsts);
  const auto chunks = dealt(messages, options);
  const std::string magic = "#ROSBAG V2.0\n";
  constexpr std::size_t kHeaderBytes = 4096;
  std::string body;
  std::string infos;
  std::vector<bool> described(firsts.size(), false);
  for (const auto& chunk : chunks) {
    std::string content;
    std::map<std::size_t, std::string> index;
    std::map<std::size_t, std::size_t> counts;
    std::int64_t first = chunk.front()->log_time_ns;
    std::int64_t last = first;
    for (const MadeMessage* message : chunk) {
      const std::size_t number = numbers.at(message->topic);
      if (!described[number]) {
        content += connection_record(number, *firsts[number], options.has_definitions);
        described[number] = true;
      }
      index[number] += ros_time(message->log_time_ns) + u32(content.size());
      ++counts[number];
      content += bag_record(
          {{"op", u8(2)}, {"conn", u32(number)}, {"time", ros_time(message->log_time_ns)}},
          message->bytes);
      first = std::min(first, message->log_time_ns);
      last = std::max(last, message->log_time_ns);
    }
    const std::size_t position = magic.size() + kHeaderBytes + body.size();
    body +=
        bag_record({{"op", u8(5)}, {"compression", options.packing}, {"size", u32(content.size())}},
                   packed_by(options.packing, content));
    std::string in_chunk;
    for (const auto& [number, entries] : index) {
      body += bag_record(
          {{"op", u8(4)}, {"ver", u32(1)}, {"conn", u32(number)}, {"count", u32(counts[number])}},
          entries);
      in_chunk += u32(number) + u32(counts[number]);
    }
    infos += bag_record({{"op", u8(6)},
                         {"ver", u32(1)},
                         {"chunk_pos", u64(position)},
                         {"start_time", ros_time(first)},
                         {"end_time", ros_time(last)},
                         {"count", u32(counts.size())}},
                        in_chunk);
  }
  std::string index;
  for (std::size_t i = 0; i < firsts.size(); ++i) {
    index += connection_record(i, *firsts[i], options.has_definitions);
  }
  index += infos;
  const std::size_t index_at = options.has_index ? magic.size() + kHeaderBytes + body.size() : 0;
  const std::string fields =
      bag_header({{"op", u8(3)},
                  {"index_pos", u64(index_at)},
                  {"conn_count", u32(options.has_index ? firsts.size() : 0)},
                  {"chunk_count", u32(options.has_index ? chunks.size() : 0)}});
  std::ofstream(file, std::ios::binary)
      << magic << sized(fields) << sized(std::string(kHeaderBytes - 8 - fields.size(), ' ')) << body
      << (options.has_index ? index : "");
}

void write_mcap(const fs::path& file, const std::vector<MadeMessage>& messages,
                const ChunkOptions& options, Wire wire) {
  const std::string magic("\x89MCAP0\r\n", 8);
  std::vector<const MadeMessage*> firsts;
  const auto numbers = numbered(messages, firsts);
  const auto description = [&](std::size_t number) {
    const MadeMessage& first = *firsts[number];
    const bool has = options.has_definitions;
    const std::string form = wire == Wire::kRos1 ? "ros1msg" : "ros2msg";
    return mcap_record(0x03, u16(number + 1) + sized(stored_type(first.type, wire)) +
                                 sized(has ? form : "") +
                                 sized(has ? definition_text(first.type, wire) : "")) +
           mcap_record(0x04, u16(number) + u16(number + 1) + sized(first.topic) +
                                 sized(wire == Wire::kRos1 ? "ros1" : "cdr") + sized(""));
  };
  std::string body =
      magic + mcap_record(0x01, sized(wire == Wire::kRos1 ? "ros1" : "ros2") + sized("a test"));
  std::string indices;
  std::map<std::size_t, std::uint64_t> counts;
  std::vector<bool> described(firsts.size(), false);
  const auto chunks = dealt(messages, options);
  for (const auto& chunk : chunks) {
    std::string content;
    std::map<std::size_t, std::string> index;
    std::int64_t first = chunk.front()->log_time_ns;
    std::int64_t last = first;
    for (const MadeMessage* message : chunk) {
      const std::size_t number = numbers.at(message->topic);
      if (!described[number]) content += description(number);
      described[number] = true;
      const auto time = static_cast<std::uint64_t>(message->log_time_ns);
      index[number] += u64(time) + u64(content.size());
      ++counts[number];
      content += mcap_record(0x05, u16(number) + u32(0) + u64(time) + u64(time) + message->bytes);
      first = std::min(first, message->log_time_ns);
      last = std::max(last, message->log_time_ns);
    }
    if (options.messages_a_chunk == 0) {
      body += content;
      continue;
    }
    const std::string packing = options.packing == "none" ? "" : options.packing;
    const std::string packed = packed_by(options.packing, content);
    const std::string record = mcap_record(
        0x06, u64(static_cast<std::uint64_t>(first)) + u64(static_cast<std::uint64_t>(last)) +
                  u64(content.size()) + u32(0) + sized(packing) + u64(packed.size()) + packed);
    std::string offsets;
    const std::size_t chunk_at = body.size();
    body += record;
    const std::size_t index_at = body.size();
    for (const auto& [number, entries] : index) {
      offsets += u16(number) + u64(body.size());
      body += mcap_record(0x07, u16(number) + sized(entries));
    }
    indices +=
        mcap_record(0x08, u64(static_cast<std::uint64_t>(first)) +
                              u64(static_cast<std::uint64_t>(last)) + u64(chunk_at) +
                              u64(record.size()) + sized(offsets) + u64(body.size() - index_at) +
                              sized(packing) + u64(packed.size()) + u64(content.size()));
  }
  std::uint64_t summary_at = 0;
  if (options.has_index) {
    body += mcap_record(0x0f, u32(0));
    summary_at = body.size();
    std::string by_channel;
    for (const auto& [number, count] : counts) by_channel += u16(number) + u64(count);
    for (std::size_t i = 0; i < firsts.size(); ++i) body += description(i);
    body += indices;
    body +=
        mcap_record(0x0b, u64(messages.size()) + u16(firsts.size()) + u32(firsts.size()) + u32(0) +
                              u32(0) + u32(chunks.size()) + u64(0) + u64(0) + sized(by_channel));
    body += mcap_record(0x02, u64(summary_at) + u64(0) + u32(0)) + magic;
  }
  std::ofstream(file, std::ios::binary) << body;
}

void write_ros2_bag(const fs::path& folder, const std::vector<MadeMessage>& messages,
                    const DatabaseOptions& options) {
  fs::create_directories(folder);
  std::vector<const MadeMessage*> firsts;
  const auto numbers = numbered(messages, firsts);
  std::string paths;
  const std::size_t each = (messages.size() + options.files - 1) / options.files;
  for (std::size_t part = 0; part < options.files; ++part) {
    const std::string name = folder.filename().string() + "_" + std::to_string(part) + ".db3";
    paths += "    - " + name + "\n";
    fs::remove(folder / name);
    sqlite3* opened = nullptr;
    sqlite3_open((folder / name).c_str(), &opened);
    const std::unique_ptr<sqlite3, decltype(&sqlite3_close)> database(opened, sqlite3_close);
    execute(opened, "PRAGMA synchronous=OFF");
    execute(opened,
            "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
            "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
            "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp "
            "INTEGER NOT NULL, data BLOB NOT NULL);");
    if (options.has_time_index) {
      execute(opened, "CREATE INDEX timestamp_idx ON messages (timestamp ASC);");
    }
    if (options.has_definitions) {
      execute(opened,
              "CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL, "
              "encoding TEXT NOT NULL, encoded_message_definition TEXT NOT NULL, "
              "type_description_hash TEXT NOT NULL);");
    }
    execute(opened, "BEGIN");
    for (std::size_t i = 0; i < firsts.size(); ++i) {
      const std::string type = stored_type(firsts[i]->type, Wire::kCdr);
      execute(opened, "INSERT INTO topics VALUES(" + std::to_string(i + 1) + ", '" +
                          firsts[i]->topic + "', '" + type + "', 'cdr', '')");
      if (options.has_definitions) {
        execute(opened,
                "INSERT INTO message_definitions(topic_type, encoding, "
                "encoded_message_definition, type_description_hash) VALUES('" +
                    type + "', 'ros2msg', '" + definition_text(firsts[i]->type, Wire::kCdr) +
                    "', '')");
      }
    }
    sqlite3_stmt* insert = nullptr;
    sqlite3_prepare_v2(opened, "INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)",
                       -1, &insert, nullptr);
    for (std::size_t i = part * each; i < std::min(messages.size(), (part + 1) * each); ++i) {
      const std::string data =
          options.pack_messages ? packed_by("zstd", messages[i].bytes) : messages[i].bytes;
      sqlite3_reset(insert);
      sqlite3_bind_int64(insert, 1, static_cast<std::int64_t>(numbers.at(messages[i].topic)) + 1);
      sqlite3_bind_int64(insert, 2, messages[i].log_time_ns);
      sqlite3_bind_blob(insert, 3, data.data(), static_cast<int>(data.size()), SQLITE_TRANSIENT);
      if (sqlite3_step(insert) != SQLITE_DONE) throw std::runtime_error(sqlite3_errmsg(opened));
    }
    sqlite3_finalize(insert);
    execute(opened, "COMMIT");
  }
  if (!options.has_metadata) return;
  std::ofstream(folder / "metadata.yaml")
      << "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n"
         "  relative_file_paths:\n"
      << paths << "  compression_format: \"" << (options.pack_messages ? "zstd" : "")
      << "\"\n  compression_mode: \"" << (options.pack_messages ? "MESSAGE" : "") << "\"\n";
}

}  // namespace traverse::testing
