#include "chunk_packing.hpp"

#include <stdexcept>

#include "packing_libraries.hpp"

namespace traverse::bags {

namespace {

void pack_by_lz4(std::string_view text, std::string& packed) {
  const Lz4Library& lz4 = lz4_library();
  LZ4F_preferences_t preferences{};
  preferences.frameInfo.blockSizeID = LZ4F_max4MB;
  preferences.frameInfo.blockMode = LZ4F_blockIndependent;
  preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
  packed.resize(lz4.bound(text.size(), &preferences));
  const std::size_t size =
      lz4.compress(packed.data(), packed.size(), text.data(), text.size(), &preferences);
  if (lz4.is_error(size) != 0) throw std::runtime_error("lz4 cannot pack a chunk");
  packed.resize(size);
}

void pack_by_zstd(std::string_view text, std::string& packed) {
  constexpr int kQuick = 1;
  const ZstdLibrary& zstd = zstd_library();
  packed.resize(zstd.bound(text.size()));
  const std::size_t size =
      zstd.compress(packed.data(), packed.size(), text.data(), text.size(), kQuick);
  if (zstd.is_error(size) != 0) throw std::runtime_error("zstd cannot pack a chunk");
  packed.resize(size);
}

}  // namespace

void pack(ChunkPacking packing, std::string_view text, std::string& packed) {
  switch (packing) {
    case ChunkPacking::kNone:
      packed = text;
      return;
    case ChunkPacking::kLz4:
      pack_by_lz4(text, packed);
      return;
    case ChunkPacking::kZstd:
      pack_by_zstd(text, packed);
      return;
  }
}

}  // namespace traverse::bags
