#include "chunk_writer.hpp"

#include <algorithm>

#include "chunk_packing.hpp"

namespace traverse::bags {

void ChunkWriter::put(std::string_view bytes) {
  stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  at_ += bytes.size();
}

void ChunkWriter::put_anew(std::uint64_t at, std::string_view bytes) {
  stream_.seekp(static_cast<std::streamoff>(at));
  stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream_.seekp(0, std::ios::end);
}

RecordBytes& ChunkWriter::index_for(std::size_t channel, std::int64_t log_time_ns) {
  if (chunk_.index.empty()) chunk_.first_ns = chunk_.last_ns = log_time_ns;
  chunk_.first_ns = std::min(chunk_.first_ns, log_time_ns);
  chunk_.last_ns = std::max(chunk_.last_ns, log_time_ns);
  return chunk_.index[channel];
}

void ChunkWriter::end_message() {
  if (chunk_.content.size() >= kChunkBytes) end_chunk();
}

void ChunkWriter::end_chunk() {
  pack(packing_, chunk_.content.text(), packed_);
  put_chunk(chunk_, packed_);
  ++chunks_;
  chunk_.content.clear();
  chunk_.index.clear();
}

void ChunkWriter::finish() {
  if (!chunk_.index.empty()) end_chunk();
  put_end();
}

}  // namespace traverse::bags
