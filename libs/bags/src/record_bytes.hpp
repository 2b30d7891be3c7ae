#pragma once

#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace traverse::bags {

/// Chunks end when they hold so much.
inline constexpr std::size_t kChunkBytes = 1 << 20;

/// Little-endian numbers and counted texts, put together as records of containers are.
class RecordBytes {
 public:
  template <typename Number>
  RecordBytes& number(Number value) {
    char raw[sizeof(Number)];
    std::memcpy(raw, &value, sizeof raw);
    text_.append(raw, sizeof raw);
    return *this;
  }
  RecordBytes& u8(std::uint8_t value) { return number(value); }
  RecordBytes& u16(std::size_t value) { return number(static_cast<std::uint16_t>(value)); }
  RecordBytes& u64(std::uint64_t value) { return number(value); }
  /// \throws std::invalid_argument for one that needs more bits
  RecordBytes& u32(std::uint64_t value) {
    if (value > std::numeric_limits<std::uint32_t>::max()) {
      throw std::invalid_argument(fmt::format("{} does not fit into 32 bits of a bag", value));
    }
    return number(static_cast<std::uint32_t>(value));
  }
  RecordBytes& sized(std::string_view text) { return u32(text.size()).raw(text); }
  RecordBytes& raw(std::string_view text) {
    text_ += text;
    return *this;
  }
  const std::string& text() const { return text_; }
  std::size_t size() const { return text_.size(); }
  void clear() { text_.clear(); }

 private:
  std::string text_;
};

}  // namespace traverse::bags
