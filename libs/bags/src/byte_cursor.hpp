#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

namespace traverse::bags {

/// What was to be read is longer than the bytes that are there.
struct CutShort {};

/// Reads little-endian numbers and pieces from bytes, one after the other.
class ByteCursor {
 public:
  explicit ByteCursor(std::span<const std::byte> bytes) : bytes_(bytes) {}

  std::size_t at() const { return at_; }
  std::size_t left() const { return bytes_.size() - at_; }

  /// \throws CutShort, as all here
  std::span<const std::byte> take(std::uint64_t count) {
    if (count > left()) throw CutShort();
    const auto piece = bytes_.subspan(at_, static_cast<std::size_t>(count));
    at_ += piece.size();
    return piece;
  }
  template <typename Number>
  Number number() {
    Number value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  /// A text behind its length as four bytes.
  std::string_view text() { return as_text(take(number<std::uint32_t>())); }

  static std::string_view as_text(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

 private:
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
};

}  // namespace traverse::bags
