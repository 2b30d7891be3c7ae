#include "unpacking.hpp"

#include <algorithm>
#include <array>
#include <bzlib.h>
#include <cstring>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "lazy_library.hpp"
#include "packing_libraries.hpp"

namespace traverse::bags {

namespace {

constexpr std::array<std::pair<std::string_view, Packing>, 5> kNames{{{"none", Packing::kNone},
                                                                      {"bz2", Packing::kBz2},
                                                                      {"lz4", Packing::kLz4},
                                                                      {"zstd", Packing::kZstd},
                                                                      {"", Packing::kNone}}};

constexpr std::size_t kLeastRoom = 64 << 10;
constexpr const char* kMissing = "the packed bytes end too early";

struct Bz2 {
  LazyLibrary library{"libbz2.so.1.0", "libbz2-1.0"};
  decltype(&::BZ2_bzDecompressInit) create = TRAVERSE_LAZY_FUNCTION(library, BZ2_bzDecompressInit);
  decltype(&::BZ2_bzDecompress) decompress = TRAVERSE_LAZY_FUNCTION(library, BZ2_bzDecompress);
  decltype(&::BZ2_bzDecompressEnd) release = TRAVERSE_LAZY_FUNCTION(library, BZ2_bzDecompressEnd);
};

/// What one step of an unpacker did.
struct Step {
  std::size_t taken = 0;
  std::size_t made = 0;
  bool is_over = false;
  std::string fault;
};

/// Calls `step` with what is left of the input and of the room until it is over. The room grows by
/// what has been unpacked; a byte more than stated shows that there is more.
template <typename StepFunction>
std::string unpack_by_steps(std::span<const std::byte> packed, std::uint64_t stated,
                            std::vector<std::byte>& bytes, const StepFunction& step) {
  const std::size_t most = static_cast<std::size_t>(stated);
  std::size_t made = 0;
  std::string fault;
  // What stands there is room already: a buffer that is used again is not filled with zeros anew.
  if (bytes.size() > most) bytes.resize(most);
  bytes.resize(std::max(bytes.size(), std::min({most, 2 * packed.size() + kLeastRoom})));
  for (;;) {
    if (made == bytes.size() && made < most) {
      bytes.resize(std::min(most, std::max(2 * made, kLeastRoom)));
    }
    std::array<std::byte, 1> beyond{};
    const bool is_full = made == most;
    const std::span<std::byte> room =
        is_full ? std::span<std::byte>(beyond) : std::span(bytes).subspan(made);
    const Step done = step(packed, room);
    packed = packed.subspan(done.taken);
    if (is_full && done.made > 0) {
      fault = fmt::format("more than the {} bytes that are stated", stated);
      break;
    }
    made += done.made;
    fault = done.fault;
    if (done.is_over || !fault.empty()) break;
    if (done.taken == 0 && done.made == 0) {
      fault = kMissing;
      break;
    }
  }
  bytes.resize(made);
  return fault;
}

std::string unpack_lz4(std::span<const std::byte> packed, std::uint64_t stated,
                       std::vector<std::byte>& bytes) {
  const Lz4Library& lz4 = lz4_library();
  LZ4F_dctx* made = nullptr;
  if (lz4.is_error(lz4.create(&made, LZ4F_VERSION)) != 0) return "lz4 gives no context";
  const std::unique_ptr<LZ4F_dctx, decltype(lz4.release)> context(made, lz4.release);
  return unpack_by_steps(
      packed, stated, bytes, [&](std::span<const std::byte> input, std::span<std::byte> room) {
        Step step;
        step.taken = input.size();
        step.made = room.size();
        const std::size_t hint = lz4.decompress(context.get(), room.data(), &step.made,
                                                input.data(), &step.taken, nullptr);
        if (lz4.is_error(hint) != 0) {
          step.fault = fmt::format("damaged lz4 data ({})", lz4.error_name(hint));
          step.made = 0;
        }
        step.is_over = hint == 0;
        return step;
      });
}

std::string unpack_zstd(std::span<const std::byte> packed, std::uint64_t stated,
                        std::vector<std::byte>& bytes) {
  const ZstdLibrary& zstd = zstd_library();
  const std::unique_ptr<ZSTD_DStream, decltype(zstd.release)> stream(zstd.create(), zstd.release);
  if (stream == nullptr) return "zstd gives no context";
  return unpack_by_steps(
      packed, stated, bytes, [&](std::span<const std::byte> input, std::span<std::byte> room) {
        ZSTD_inBuffer in{input.data(), input.size(), 0};
        ZSTD_outBuffer out{room.data(), room.size(), 0};
        const std::size_t hint = zstd.decompress(stream.get(), &out, &in);
        Step step{in.pos, out.pos, hint == 0, {}};
        if (zstd.is_error(hint) != 0) {
          step.fault = fmt::format("damaged zstd data ({})", zstd.error_name(hint));
          step.is_over = false;
        }
        return step;
      });
}

std::string unpack_bz2(std::span<const std::byte> packed, std::uint64_t stated,
                       std::vector<std::byte>& bytes) {
  static const Bz2 bz2;
  bz_stream stream{};
  if (bz2.create(&stream, 0, 0) != BZ_OK) return "bz2 gives no context";
  const std::unique_ptr<bz_stream, decltype(bz2.release)> ends(&stream, bz2.release);
  return unpack_by_steps(
      packed, stated, bytes, [&](std::span<const std::byte> input, std::span<std::byte> room) {
        stream.next_in = const_cast<char*>(reinterpret_cast<const char*>(input.data()));
        stream.avail_in = static_cast<unsigned>(input.size());
        stream.next_out = reinterpret_cast<char*>(room.data());
        stream.avail_out = static_cast<unsigned>(room.size());
        const int result = bz2.decompress(&stream);
        Step step{input.size() - stream.avail_in,
                  room.size() - stream.avail_out,
                  result == BZ_STREAM_END,
                  {}};
        if (result != BZ_OK && result != BZ_STREAM_END) {
          step.fault = fmt::format("damaged bz2 data (error {})", result);
        }
        return step;
      });
}

}  // namespace

std::optional<Packing> packing_named(std::string_view name) {
  for (const auto& [known, packing] : kNames) {
    if (known == name) return packing;
  }
  return std::nullopt;
}

std::string_view name_of(Packing packing) {
  for (const auto& [name, value] : kNames) {
    if (value == packing) return name;
  }
  return "unknown";
}

std::string unpack(Packing packing, std::span<const std::byte> packed, std::uint64_t stated,
                   std::vector<std::byte>& bytes) {
  switch (packing) {
    case Packing::kNone:
      bytes.assign(packed.begin(), packed.end());
      return stated > packed.size() ? kMissing : "";
    case Packing::kBz2:
      return unpack_bz2(packed, stated, bytes);
    case Packing::kLz4:
      return unpack_lz4(packed, stated, bytes);
    case Packing::kZstd:
      return unpack_zstd(packed, stated, bytes);
  }
  return "packed in an unknown way";
}

bool is_zstd(std::span<const std::byte> bytes) {
  constexpr std::array<unsigned char, 4> kZstdMagic{0x28, 0xb5, 0x2f, 0xfd};
  return bytes.size() > kZstdMagic.size() &&
         std::memcmp(bytes.data(), kZstdMagic.data(), kZstdMagic.size()) == 0;
}

}  // namespace traverse::bags
