#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <ostream>
#include <string>
#include <string_view>

#include "traverse/bags/container_writer.hpp"

#include "record_bytes.hpp"

namespace traverse::bags {

/// What the writers of containers with chunks have in common: messages are put into a chunk until
/// it is full, and a chunk is packed and written with the index of its messages.
class ChunkWriter : public ContainerWriter {
 public:
  void finish() final;

 protected:
  ChunkWriter(std::ostream& stream, ChunkPacking packing) : stream_(stream), packing_(packing) {}

  struct OpenChunk {
    RecordBytes content;
    std::map<std::size_t, RecordBytes> index;  ///< of the messages, by channel
    std::int64_t first_ns = 0;                 ///< of their log times
    std::int64_t last_ns = 0;
  };

  /// The index of a channel, to which the caller adds where in the content the message will stand.
  RecordBytes& index_for(std::size_t channel, std::int64_t log_time_ns);
  /// Writes the chunk if it is full. To be called when the message stands in it.
  void end_message();

  OpenChunk& chunk() { return chunk_; }
  std::uint64_t chunks() const { return chunks_; }  ///< that are written
  ChunkPacking packing() const { return packing_; }

  void put(std::string_view bytes);
  std::uint64_t at() const { return at_; }  ///< bytes that were put
  /// Writes over what was put there.
  void put_anew(std::uint64_t at, std::string_view bytes);

 private:
  /// Puts a chunk, packed, and its index. `chunks()` is the number of those before it.
  virtual void put_chunk(const OpenChunk& full, std::string_view packed) = 0;
  /// Puts what stands behind the last chunk.
  virtual void put_end() = 0;

  void end_chunk();

  std::ostream& stream_;
  ChunkPacking packing_;
  std::uint64_t at_ = 0;
  OpenChunk chunk_;
  std::uint64_t chunks_ = 0;
  std::string packed_;  ///< kept for its room
};

}  // namespace traverse::bags
