#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <queue>
#include <span>
#include <string>
#include <vector>

#include "traverse/bags/message_container.hpp"

#include "random_access_file.hpp"
#include "unpacking.hpp"

namespace traverse::bags {

/// A piece of a file with messages, packed as one.
struct Chunk {
  std::uint64_t position = 0;  ///< of its packed bytes
  std::uint64_t packed = 0;    ///< how many these are; fewer where the file is cut off
  std::uint64_t unpacked = 0;  ///< as the file states
  Packing packing = Packing::kNone;
  std::int64_t first_ns = 0;  ///< log times
  std::int64_t last_ns = 0;
  std::vector<std::uint32_t> channels = {};  ///< that it has messages of; empty: not known
};

/// A container whose messages stand in chunks, in any order within a chunk and with chunks in any
/// order: they come out by their log times. A chunk is unpacked when the time has come to its first
/// message; of those that overlap in time at most kMostCached bytes are kept, others are unpacked
/// again. Whoever opens a recording begins several times: the first chunks are kept until it goes
/// on.
class ChunkedContainer : public MessageContainer {
 public:
  const Contents& contents() const override { return contents_; }
  void begin(const std::vector<std::size_t>& channels) override;
  std::optional<Message> next() override;
  const Losses& losses() const override { return losses_; }
  double share_read() const override;
  std::shared_ptr<const Position> position() const override;
  void return_to(const Position& position) override;

 protected:
  static constexpr std::uint64_t kMostCached = 48 << 20;
  static constexpr std::size_t kHeadChunks = 16;

  /// Where a message stands in an unpacked chunk.
  struct Found {
    std::uint32_t channel = 0;
    std::int64_t log_time_ns = 0;
    std::size_t offset = 0;
    std::size_t size = 0;
  };

  explicit ChunkedContainer(const std::filesystem::path& file) : file_(file) {}

  /// Of a message whose channel the file does not describe: counted, not given.
  static constexpr std::uint32_t kUndescribed = 0xffffffff;

  /// Tells every message of an unpacked chunk. \returns what ended it too early; empty if nothing
  virtual std::string find_messages(std::span<const std::byte> chunk,
                                    std::vector<Found>& messages) = 0;
  /// Takes in the channels that an unpacked chunk describes.
  virtual void find_channels(std::span<const std::byte> chunk) = 0;

  /// The channel of equal topic, type, encoding and definition, which is added if there is none:
  /// publishers of one topic have a channel each in a file.
  std::uint32_t index_of(Channel channel);

  /// Of a file without an index: unpacks the chunk for its channels, times and counts, and keeps it
  /// if it has messages.
  void look_into(Chunk chunk);

  /// How the chunks are packed: "lz4, none".
  std::string packings() const;

  /// Puts the chunks, which the reader has filled in, in the order of their first times and fills
  /// in times and number of messages. \throws files::InputError if there is neither a channel nor a
  /// message
  void finish_opening(const std::string& kind);

  static std::string place_of(const Chunk& chunk);

  RandomAccessFile file_;
  Contents contents_;
  std::vector<Chunk> chunks_;
  Losses losses_;

 private:
  struct Entry {
    Found message;
    std::size_t chunk = 0;
    bool operator>(const Entry& other) const;
  };
  struct Cached {
    std::size_t chunk = 0;
    std::uint64_t last_used = 0;
    std::vector<std::byte> bytes;
  };
  struct Here;

  /// The chunk's bytes, as many as can be had. \returns what is wrong; empty if nothing
  std::string load(const Chunk& chunk, std::vector<std::byte>& bytes);
  void tell_undescribed(const std::vector<Found>& messages, const Chunk& chunk);
  void release();
  bool has_wanted(const Chunk& chunk) const;
  void take_chunk(std::size_t chunk);
  Cached& cache(std::size_t chunk);
  void make_room(std::uint64_t bytes);

  std::vector<bool> wanted_;
  std::size_t next_chunk_ = 0;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> waiting_;
  std::map<std::size_t, std::size_t> left_;  ///< messages that wait, by chunk; none: not listed
  std::vector<Cached> cached_;
  std::vector<std::vector<std::byte>> spare_;  ///< buffers to be used again
  std::vector<std::byte> packed_;
  std::vector<Found> found_;
  std::vector<bool> is_told_;  ///< losses of a chunk count once
  std::uint64_t uses_ = 0;
};

}  // namespace traverse::bags
