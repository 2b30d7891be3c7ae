#pragma once

#include <lz4frame.h>
#include <zstd.h>

#include "lazy_library.hpp"

namespace traverse::bags {

/// lz4's frames.
struct Lz4Library {
  LazyLibrary library{"liblz4.so.1", "liblz4-1"};
  decltype(&::LZ4F_compressFrameBound) bound =
      TRAVERSE_LAZY_FUNCTION(library, LZ4F_compressFrameBound);
  decltype(&::LZ4F_compressFrame) compress = TRAVERSE_LAZY_FUNCTION(library, LZ4F_compressFrame);
  decltype(&::LZ4F_createDecompressionContext) create =
      TRAVERSE_LAZY_FUNCTION(library, LZ4F_createDecompressionContext);
  decltype(&::LZ4F_freeDecompressionContext) release =
      TRAVERSE_LAZY_FUNCTION(library, LZ4F_freeDecompressionContext);
  decltype(&::LZ4F_decompress) decompress = TRAVERSE_LAZY_FUNCTION(library, LZ4F_decompress);
  decltype(&::LZ4F_isError) is_error = TRAVERSE_LAZY_FUNCTION(library, LZ4F_isError);
  decltype(&::LZ4F_getErrorName) error_name = TRAVERSE_LAZY_FUNCTION(library, LZ4F_getErrorName);
};

/// zstd's frames.
struct ZstdLibrary {
  LazyLibrary library{"libzstd.so.1", "libzstd1"};
  decltype(&::ZSTD_compressBound) bound = TRAVERSE_LAZY_FUNCTION(library, ZSTD_compressBound);
  decltype(&::ZSTD_compress) compress = TRAVERSE_LAZY_FUNCTION(library, ZSTD_compress);
  decltype(&::ZSTD_createDStream) create = TRAVERSE_LAZY_FUNCTION(library, ZSTD_createDStream);
  decltype(&::ZSTD_freeDStream) release = TRAVERSE_LAZY_FUNCTION(library, ZSTD_freeDStream);
  decltype(&::ZSTD_decompressStream) decompress =
      TRAVERSE_LAZY_FUNCTION(library, ZSTD_decompressStream);
  decltype(&::ZSTD_isError) is_error = TRAVERSE_LAZY_FUNCTION(library, ZSTD_isError);
  decltype(&::ZSTD_getErrorName) error_name = TRAVERSE_LAZY_FUNCTION(library, ZSTD_getErrorName);
};

/// Loaded when first asked for. \throws NoLibrary
const Lz4Library& lz4_library();
const ZstdLibrary& zstd_library();

}  // namespace traverse::bags
