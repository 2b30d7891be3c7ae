#include "packing_libraries.hpp"

namespace traverse::bags {

const Lz4Library& lz4_library() {
  static const Lz4Library lz4;
  return lz4;
}

const ZstdLibrary& zstd_library() {
  static const ZstdLibrary zstd;
  return zstd;
}

}  // namespace traverse::bags
