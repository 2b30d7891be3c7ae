#include "chunk_packing.hpp"

#include <lz4frame.h>
#include <stdexcept>
#include <zstd.h>

#include "lazy_library.hpp"

namespace traverse::bags {

namespace {

struct Lz4Packer {
  LazyLibrary library{"liblz4.so.1", "liblz4-1"};
  decltype(&::LZ4F_compressFrameBound) bound =
      TRAVERSE_LAZY_FUNCTION(library, LZ4F_compressFrameBound);
  decltype(&::LZ4F_compressFrame) compress = TRAVERSE_LAZY_FUNCTION(library, LZ4F_compressFrame);
  decltype(&::LZ4F_isError) is_error = TRAVERSE_LAZY_FUNCTION(library, LZ4F_isError);
};

struct ZstdPacker {
  LazyLibrary library{"libzstd.so.1", "libzstd1"};
  decltype(&::ZSTD_compressBound) bound = TRAVERSE_LAZY_FUNCTION(library, ZSTD_compressBound);
  decltype(&::ZSTD_compress) compress = TRAVERSE_LAZY_FUNCTION(library, ZSTD_compress);
  decltype(&::ZSTD_isError) is_error = TRAVERSE_LAZY_FUNCTION(library, ZSTD_isError);
};

void pack_by_lz4(std::string_view text, std::string& packed) {
  static const Lz4Packer lz4;
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
  static const ZstdPacker zstd;
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
