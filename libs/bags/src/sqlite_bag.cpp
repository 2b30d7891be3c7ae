#include <algorithm>
#include <map>
#include <sqlite3.h>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "traverse/bags/message_container.hpp"
#include "traverse/files/binary_file.hpp"
#include "traverse/files/input_error.hpp"

#include "byte_cursor.hpp"
#include "lazy_library.hpp"
#include "message_type_name.hpp"
#include "random_access_file.hpp"
#include "unpacking.hpp"

namespace traverse::bags {

using files::InputError;
using files::Place;

namespace {

constexpr std::string_view kSqliteMagic("SQLite format 3\0", 16);

struct SqliteLibrary {
  LazyLibrary library{"libsqlite3.so.0", "libsqlite3-0"};
  decltype(&::sqlite3_open_v2) open = TRAVERSE_LAZY_FUNCTION(library, sqlite3_open_v2);
  decltype(&::sqlite3_close) close = TRAVERSE_LAZY_FUNCTION(library, sqlite3_close);
  decltype(&::sqlite3_errmsg) message = TRAVERSE_LAZY_FUNCTION(library, sqlite3_errmsg);
  decltype(&::sqlite3_exec) exec = TRAVERSE_LAZY_FUNCTION(library, sqlite3_exec);
  decltype(&::sqlite3_limit) limit = TRAVERSE_LAZY_FUNCTION(library, sqlite3_limit);
  decltype(&::sqlite3_prepare_v2) prepare = TRAVERSE_LAZY_FUNCTION(library, sqlite3_prepare_v2);
  decltype(&::sqlite3_finalize) finalize = TRAVERSE_LAZY_FUNCTION(library, sqlite3_finalize);
  decltype(&::sqlite3_step) step = TRAVERSE_LAZY_FUNCTION(library, sqlite3_step);
  decltype(&::sqlite3_reset) reset = TRAVERSE_LAZY_FUNCTION(library, sqlite3_reset);
  decltype(&::sqlite3_bind_int64) bind = TRAVERSE_LAZY_FUNCTION(library, sqlite3_bind_int64);
  decltype(&::sqlite3_column_int64) integer = TRAVERSE_LAZY_FUNCTION(library, sqlite3_column_int64);
  decltype(&::sqlite3_column_blob) blob = TRAVERSE_LAZY_FUNCTION(library, sqlite3_column_blob);
  decltype(&::sqlite3_column_text) text = TRAVERSE_LAZY_FUNCTION(library, sqlite3_column_text);
  decltype(&::sqlite3_column_bytes) bytes = TRAVERSE_LAZY_FUNCTION(library, sqlite3_column_bytes);
};

const SqliteLibrary& sqlite_for(const std::filesystem::path& file) {
  try {
    static const SqliteLibrary library;
    return library;
  } catch (const NoLibrary& error) {
    throw InputError(file, Place::whole_file(), "SQLite to read it with", error.what());
  }
}

/// A query and where it stands.
class Query {
 public:
  Query(const SqliteLibrary& library, sqlite3* database, const std::string& text)
      : library_(&library) {
    if (library.prepare(database, text.c_str(), -1, &statement_, nullptr) != SQLITE_OK) {
      statement_ = nullptr;
    }
  }
  ~Query() { library_->finalize(statement_); }
  Query(const Query&) = delete;
  Query& operator=(const Query&) = delete;

  bool is_valid() const { return statement_ != nullptr; }
  /// SQLITE_ROW, SQLITE_DONE or what went wrong.
  int step() { return statement_ == nullptr ? SQLITE_ERROR : library_->step(statement_); }
  void restart(std::initializer_list<std::int64_t> values) {
    library_->reset(statement_);
    int index = 0;
    for (const std::int64_t value : values) library_->bind(statement_, ++index, value);
  }
  std::int64_t integer(int column) const { return library_->integer(statement_, column); }
  std::string text(int column) const {
    const auto* begin = library_->text(statement_, column);
    return begin == nullptr ? "" : reinterpret_cast<const char*>(begin);
  }
  std::span<const std::byte> blob(int column) const {
    const auto* begin = static_cast<const std::byte*>(library_->blob(statement_, column));
    return {begin,
            begin == nullptr ? 0 : static_cast<std::size_t>(library_->bytes(statement_, column))};
  }

 private:
  const SqliteLibrary* library_;
  sqlite3_stmt* statement_ = nullptr;
};

class SqliteBag : public MessageContainer {
 public:
  explicit SqliteBag(const std::filesystem::path& file)
      : path_(file), sqlite_(sqlite_for(file)), size_(RandomAccessFile(file).size()) {
    open();
    read_topics();
    count();
    by_id_ = std::make_unique<Query>(sqlite_, database_.get(),
                                     "SELECT topic_id, data FROM messages WHERE id = ?1");
  }

  const Contents& contents() const override { return contents_; }
  const Losses& losses() const override { return losses_; }
  double share_read() const override {
    return contents_.messages == 0
               ? 1
               : static_cast<double>(read_) / static_cast<double>(contents_.messages);
  }

  void begin(const std::vector<std::size_t>& channels) override {
    wanted_.assign(contents_.channels.size(), false);
    for (const std::size_t channel : channels) wanted_.at(channel) = true;
    start({INT64_MIN, INT64_MIN, 0});
  }

  std::optional<Message> next() override {
    for (;;) {
      if (in_order_ == nullptr) return std::nullopt;
      const int result = in_order_->step();
      if (result != SQLITE_ROW) {
        if (result != SQLITE_DONE) lose_rest();
        in_order_.reset();
        return std::nullopt;
      }
      ++read_;
      last_ = {in_order_->integer(0), in_order_->integer(1), read_};
      by_id_->restart({last_.id});
      if (by_id_->step() != SQLITE_ROW) {
        losses_.add("message that the database cannot give: " + error(), place());
        continue;
      }
      const auto channel = channel_of_.find(by_id_->integer(0));
      if (channel == channel_of_.end()) {
        losses_.add("message of a topic that the bag does not describe", place());
        continue;
      }
      if (!wanted_[channel->second]) continue;
      std::span<const std::byte> bytes = by_id_->blob(1);
      if (is_zstd(bytes) && !unpack_message(bytes)) continue;
      return Message{channel->second, last_.time_ns, bytes};
    }
  }

  std::shared_ptr<const Position> position() const override {
    auto here = std::make_shared<Here>();
    here->last = last_;
    here->is_over = in_order_ == nullptr;
    here->wanted = wanted_;
    return here;
  }

  void return_to(const Position& position) override {
    const auto& there = dynamic_cast<const Here&>(position);
    wanted_ = there.wanted;
    start(there.last);
    if (there.is_over) in_order_.reset();
  }

 private:
  struct Row {
    std::int64_t time_ns = 0;
    std::int64_t id = 0;
    std::uint64_t number = 0;  ///< of rows up to it
  };
  struct Here : Position {
    Row last;
    bool is_over = false;
    std::vector<bool> wanted;
  };

  std::string error() const { return sqlite_.message(database_.get()); }
  std::string place() const { return fmt::format("message {}", last_.id); }

  InputError unusable(const std::string& found) const {
    return {path_, Place::whole_file(), "a ROS 2 bag: tables 'topics' and 'messages'", found};
  }

  /// A bag that is still written to, or was when the recorder ended, has its last messages in a
  /// file of its own beside it, which SQLite takes in where it may write there.
  void open() {
    if (try_open("?mode=ro")) return;
    if (try_open("?mode=ro&immutable=1")) {
      if (std::filesystem::exists(path_.string() + "-wal")) {
        losses_.add("what stands in " + path_.filename().string() +
                        "-wal beside it is left out: the folder cannot be written to",
                    path_.filename().string());
      }
      return;
    }
    // One that was cut off is refused as a whole unless it is read like this.
    if (try_open("?mode=ro&immutable=1", "PRAGMA writable_schema=ON")) {
      is_damaged_ = true;
      return;
    }
    throw unusable(error());
  }

  bool try_open(const std::string& how, const char* first = nullptr) {
    std::string uri = "file:";
    for (const char c : std::filesystem::absolute(path_).string()) {
      if (c == '%' || c == '?' || c == '#') {
        uri += fmt::format("%{:02x}", static_cast<unsigned>(c));
      } else {
        uri += c;
      }
    }
    sqlite3* opened = nullptr;
    const int result =
        sqlite_.open((uri + how).c_str(), &opened, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
    database_ = std::shared_ptr<sqlite3>(opened, sqlite_.close);
    if (result != SQLITE_OK) return false;
    // A record that states more than the file has is refused before memory is taken.
    const auto longest = std::min<std::uint64_t>(size_, files::kMostBytesAtOnce - 1);
    sqlite_.limit(database_.get(), SQLITE_LIMIT_LENGTH,
                  static_cast<int>(std::max<std::uint64_t>(longest, 1 << 20)));
    if (first != nullptr) sqlite_.exec(database_.get(), first, nullptr, nullptr, nullptr);
    return Query(sqlite_, database_.get(), "SELECT id FROM topics LIMIT 1").is_valid();
  }

  void read_topics() {
    std::map<std::string, std::pair<std::string, std::string>> definitions;  // by type
    Query stored(sqlite_, database_.get(),
                 "SELECT topic_type, encoding, encoded_message_definition FROM "
                 "message_definitions");
    while (stored.is_valid() && stored.step() == SQLITE_ROW) {
      definitions[stored.text(0)] = {stored.text(1), stored.text(2)};
    }
    Query topics(sqlite_, database_.get(),
                 "SELECT id, name, type, serialization_format FROM topics ORDER BY id");
    if (!topics.is_valid()) throw unusable(error());
    int result = SQLITE_DONE;
    while ((result = topics.step()) == SQLITE_ROW) {
      Channel channel;
      channel.topic = topics.text(1);
      const std::string type = topics.text(2);
      channel.type = plain_type_name(type);
      channel.encoding = topics.text(3);
      if (channel.encoding == "cdr") channel.serialization = Serialization::kCdr;
      if (const auto known = definitions.find(type); known != definitions.end()) {
        const auto& [form, text] = known->second;
        if (!text.empty() && form == "ros2msg") channel.definition_form = DefinitionForm::kMsg;
        if (!text.empty() && form == "ros2idl") channel.definition_form = DefinitionForm::kIdl;
        if (channel.definition_form != DefinitionForm::kNone) channel.definition = text;
      }
      channel_of_[topics.integer(0)] = contents_.channels.size();
      contents_.channels.push_back(std::move(channel));
    }
    if (result != SQLITE_DONE) throw unusable(error());
  }

  void count() {
    Query counts(sqlite_, database_.get(),
                 "SELECT topic_id, count(*), min(timestamp), max(timestamp) FROM messages GROUP BY "
                 "topic_id");
    if (!counts.is_valid()) throw unusable(error());
    int result = SQLITE_DONE;
    while ((result = counts.step()) == SQLITE_ROW) {
      const auto count = static_cast<std::uint64_t>(counts.integer(1));
      const bool is_first = contents_.messages == 0;
      contents_.messages += count;
      contents_.first_ns =
          is_first ? counts.integer(2) : std::min(contents_.first_ns, counts.integer(2));
      contents_.last_ns =
          is_first ? counts.integer(3) : std::max(contents_.last_ns, counts.integer(3));
      if (const auto channel = channel_of_.find(counts.integer(0)); channel != channel_of_.end()) {
        contents_.channels[channel->second].count = count;
      }
    }
    contents_.how = fmt::format("SQLite database of {} messages", contents_.messages);
    if (result != SQLITE_DONE) is_damaged_ = true;
    if (is_damaged_) count_one_by_one();
  }

  /// Of a database that ends too early: the index may be gone, the messages stand as they came.
  void count_one_by_one() {
    for (Channel& channel : contents_.channels) channel.count = 0;
    contents_.messages = 0;
    Query rows(sqlite_, database_.get(),
               "SELECT topic_id, timestamp, id FROM messages NOT INDEXED");
    while (rows.is_valid() && rows.step() == SQLITE_ROW) {
      const std::int64_t time = rows.integer(1);
      const bool is_first = contents_.messages++ == 0;
      contents_.first_ns = is_first ? time : std::min(contents_.first_ns, time);
      contents_.last_ns = is_first ? time : std::max(contents_.last_ns, time);
      const auto channel = channel_of_.find(rows.integer(0));
      if (channel != channel_of_.end()) ++contents_.channels[channel->second].count;
    }
    contents_.how =
        fmt::format("damaged SQLite database: {} messages were found", contents_.messages);
  }

  void start(const Row& after) {
    read_ = after.number;
    last_ = after;
    // The order needs times and numbers only, which the index of rosbag2 has. SQLite would copy the
    // messages for it.
    in_order_ = std::make_unique<Query>(
        sqlite_, database_.get(),
        is_damaged_ ? "SELECT timestamp, id FROM messages NOT INDEXED WHERE id > ?2"
                    : "SELECT timestamp, id FROM messages WHERE timestamp >= ?1 AND (timestamp, "
                      "id) > (?1, ?2) ORDER BY timestamp, id");
    if (!in_order_->is_valid()) throw unusable(error());
    in_order_->restart({after.time_ns, after.id});
  }

  void lose_rest() {
    losses_.add("the database is damaged: what follows is lost (" + error() + ")",
                fmt::format("after message {}", last_.id));
  }

  bool unpack_message(std::span<const std::byte>& bytes) {
    try {
      const std::string fault = unpack(Packing::kZstd, bytes, files::kMostBytesAtOnce, unpacked_);
      if (fault.empty()) {
        bytes = unpacked_;
        return true;
      }
      losses_.add("message that cannot be unpacked: " + fault, place());
      return false;
    } catch (const NoLibrary& error) {
      throw InputError(path_, Place::whole_file(), "zstd to unpack its messages with",
                       error.what());
    }
  }

  std::filesystem::path path_;
  const SqliteLibrary& sqlite_;
  std::uint64_t size_;
  std::shared_ptr<sqlite3> database_;
  Contents contents_;
  Losses losses_;
  std::map<std::int64_t, std::size_t> channel_of_;  ///< by topic
  std::vector<bool> wanted_;
  std::unique_ptr<Query> in_order_;
  std::unique_ptr<Query> by_id_;
  std::vector<std::byte> unpacked_;
  Row last_;
  std::uint64_t read_ = 0;
  bool is_damaged_ = false;
};

}  // namespace

bool is_sqlite(const std::filesystem::path& file) {
  const auto bytes = first_bytes(file, kSqliteMagic.size());
  return ByteCursor::as_text(bytes) == kSqliteMagic;
}

std::unique_ptr<MessageContainer> open_sqlite_bag(const std::filesystem::path& file) {
  return std::make_unique<SqliteBag>(file);
}

}  // namespace traverse::bags
