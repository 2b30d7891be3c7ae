#include "traverse/files/sealed_json.hpp"

#include <stdexcept>

#include <fmt/format.h>

#include "traverse/files/digest.hpp"
#include "traverse/files/json_document.hpp"

namespace traverse::files {

namespace {

constexpr std::string_view kFirstLine = "{\n";
constexpr std::size_t kDigits = 64;
constexpr std::size_t kDigitsShown = 12;

std::string line_begin() { return fmt::format(" \"{}\": \"", kSealKey); }

constexpr std::string_view kLineEnd = "\",\n";

}  // namespace

std::string sealed_json(std::string_view json) {
  if (!json.starts_with(kFirstLine)) {
    throw std::invalid_argument("a JSON object of several lines can be sealed, nothing else");
  }
  std::string text(kFirstLine);
  text += line_begin();
  text += sha256_of_text(json);
  text += kLineEnd;
  text += json.substr(kFirstLine.size());
  return text;
}

bool require_seal(std::string_view text, const std::filesystem::path& file) {
  const auto document = JsonDocument::parse(text, file);
  if (!document.root().has(kSealKey)) return false;
  const std::string stated = document.root()[kSealKey].text();
  const std::string head = std::string(kFirstLine) + line_begin() + stated + std::string(kLineEnd);
  const bool is_in_form = stated.size() == kDigits && text.starts_with(head);
  const std::string found =
      is_in_form ? sha256_of_text(std::string(kFirstLine) + std::string(text.substr(head.size())))
                 : "";
  if (is_in_form && found == stated) return true;
  throw InputError(file, Place::key(kSealKey),
                   fmt::format("the SHA-256 of the other lines, {}...",
                               in_quotes(stated.substr(0, kDigitsShown))),
                   is_in_form ? fmt::format("'{}...': the file was edited, or is damaged",
                                            found.substr(0, kDigitsShown))
                              : "lines in another form: the file was edited");
}

}  // namespace traverse::files
