#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace traverse::bags {

enum class Packing { kNone, kBz2, kLz4, kZstd };

/// "" and "none" are kNone; nothing for a name that is not known.
std::optional<Packing> packing_named(std::string_view name);
std::string_view name_of(Packing packing);

/// Unpacks `packed` into `bytes`, which hold all that could be unpacked also if the rest is missing
/// or damaged. Lz4 is the frame format, which is also that of ROS 1 bags (magic number 0x184D2204).
/// Memory follows what is really unpacked.
/// \param stated bytes that the container says there are, bounded by the caller: no more are
/// unpacked
/// \returns what is wrong; empty if nothing. \throws NoLibrary
std::string unpack(Packing packing, std::span<const std::byte> packed, std::uint64_t stated,
                   std::vector<std::byte>& bytes);

/// Whether `bytes` begin like a frame of zstd.
bool is_zstd(std::span<const std::byte> bytes);

}  // namespace traverse::bags
