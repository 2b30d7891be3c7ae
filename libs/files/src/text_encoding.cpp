#include "traverse/files/text_encoding.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace traverse::files {

using namespace std::string_view_literals;

namespace {

constexpr std::string_view kUtf8Mark = "\xEF\xBB\xBF"sv;
constexpr std::size_t kLookedAt = 64;

/// Whether the bytes at `nul`, `nul` + 2, ... are NUL and those between them are not.
bool has_nul_every_other(std::string_view head, std::size_t nul) {
  constexpr std::size_t kFewest = 4;
  const std::size_t looked_at = std::min(head.size(), kLookedAt) / 2 * 2;
  if (looked_at < kFewest) return false;
  for (std::size_t i = 0; i < looked_at; ++i) {
    if ((head[i] == '\0') != (i % 2 == nul)) return false;
  }
  return true;
}

/// "UTF-16LE" as iconv calls it; empty: none of them.
std::string_view other_encoding(std::string_view head) {
  if (head.starts_with("\xFF\xFE\0\0"sv)) return "UTF-32LE";
  if (head.starts_with("\0\0\xFE\xFF"sv)) return "UTF-32BE";
  if (head.starts_with("\xFF\xFE"sv) || has_nul_every_other(head, 1)) return "UTF-16LE";
  if (head.starts_with("\xFE\xFF"sv) || has_nul_every_other(head, 0)) return "UTF-16BE";
  return {};
}

}  // namespace

std::size_t byte_order_mark(std::string_view head, const std::filesystem::path& file) {
  if (head.starts_with(kUtf8Mark)) return kUtf8Mark.size();
  const std::string_view encoding = other_encoding(head);
  if (encoding.empty()) return 0;
  throw OtherEncoding(file, Place::whole_file(), "text in UTF-8 or ASCII",
                      fmt::format("{} text; save it as UTF-8, or: iconv -f {} -t UTF-8 {} > COPY",
                                  encoding.substr(0, 6), encoding, file.string()));
}

}  // namespace traverse::files
