#include "traverse/files/json_document.hpp"

#include <algorithm>
#include <limits>
#include <type_traits>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "traverse/files/text_file.hpp"

namespace traverse::files {

using Json = nlohmann::ordered_json;

struct JsonDocument::Content {
  std::filesystem::path file;
  Json json;
};

namespace {

constexpr const char* kKind = "JSON";

Place place_of(std::string_view text, std::size_t byte) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(byte, text.size()));
  return Place::line(1 + static_cast<std::size_t>(std::count(text.begin(), end, '\n')));
}

/// The end of the line that the byte stands in, from a little before it on.
std::string text_around(std::string_view text, std::size_t byte) {
  constexpr std::size_t kBefore = 20;
  if (byte >= text.size()) return "its end";
  const std::size_t line = text.rfind('\n', byte) + 1;  // npos + 1 is the beginning
  const std::size_t begin = std::max(line, byte > kBefore ? byte - kBefore : 0);
  return in_quotes(text.substr(begin, text.find('\n', byte) - begin));
}

/// The byte from which on objects and lists are nested deeper than allowed, if there is one. Looked
/// for before the text becomes a tree, which the JSON library follows by recursion.
std::optional<std::size_t> too_deep_from(std::string_view text) {
  std::size_t level = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      if (++level > JsonDocument::kMostLevels) return i;
    } else if ((c == '}' || c == ']') && level > 0) {
      --level;
    }
  }
  return std::nullopt;
}

Json tree_of(std::string_view text, const std::filesystem::path& file) {
  if (const auto byte = too_deep_from(text)) {
    throw InputError(file, place_of(text, *byte),
                     fmt::format("{} of at most {} levels", kKind, JsonDocument::kMostLevels),
                     "more objects and lists within each other");
  }
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    const std::size_t byte = error.byte > 0 ? error.byte - 1 : 0;  // it counts from 1
    throw InputError(file, place_of(text, byte), kKind, text_around(text, byte));
  } catch (const Json::out_of_range&) {  // it does not say where
    throw InputError(file, Place::whole_file(), "numbers up to 1.8e308", "a larger one");
  }
}

template <typename Value>
bool holds(const Json& json) {
  if constexpr (std::is_same_v<Value, bool>) {
    return json.is_boolean();
  } else if constexpr (std::is_unsigned_v<Value>) {
    return json.is_number_unsigned();
  } else if constexpr (std::is_integral_v<Value>) {
    // What does not fit is held unsigned and would be read as negative.
    return json.is_number_integer() &&
           (!json.is_number_unsigned() || json.get<std::uint64_t>() <= INT64_MAX);
  } else if constexpr (std::is_floating_point_v<Value>) {
    return json.is_number();
  } else {
    return json.is_string();
  }
}

template <typename Value>
const char* name_of() {
  if constexpr (std::is_same_v<Value, bool>) return "true or false";
  if constexpr (std::is_unsigned_v<Value>) return "a count";
  if constexpr (std::is_integral_v<Value>) return "a whole number";
  if constexpr (std::is_floating_point_v<Value>) return "a number";
  return "a text";
}

const Json& of(const void* json) { return *static_cast<const Json*>(json); }

template <typename Value>
Value single(const JsonValue& value, const void* json) {
  if (!holds<Value>(of(json))) throw value.error(name_of<Value>());
  return of(json).get<Value>();
}

}  // namespace

JsonDocument::JsonDocument(std::unique_ptr<const Content> content) : content_(std::move(content)) {}
JsonDocument::JsonDocument(JsonDocument&&) noexcept = default;
JsonDocument& JsonDocument::operator=(JsonDocument&&) noexcept = default;
JsonDocument::~JsonDocument() = default;

JsonDocument JsonDocument::read(const std::filesystem::path& file) {
  return parse(read_text(file), file);
}

JsonDocument JsonDocument::parse(std::string_view text, const std::filesystem::path& file) {
  return JsonDocument(std::make_unique<const Content>(Content{file, tree_of(text, file)}));
}

JsonValue JsonDocument::root() const { return {*content_, &content_->json, {}}; }

JsonValue JsonValue::operator[](std::string_view key) const {
  const Json& json = of(json_);
  std::string path = path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
  const auto found = json.is_object() ? json.find(key) : json.end();
  if (found == json.end()) {
    throw JsonValue(*document_, json_, std::move(path)).error("a value", "none");
  }
  return {*document_, &*found, std::move(path)};
}

JsonValue JsonValue::operator[](std::size_t index) const {
  if (index >= size()) throw error(fmt::format("a list of {} and more", index + 1));
  return {*document_, &of(json_)[index], fmt::format("{}.{}", path_, index)};
}

bool JsonValue::has(std::string_view key) const {
  return of(json_).is_object() && of(json_).find(key) != of(json_).end();
}
bool JsonValue::is_null() const { return of(json_).is_null(); }
bool JsonValue::is_object() const { return of(json_).is_object(); }
bool JsonValue::is_list() const { return of(json_).is_array(); }
bool JsonValue::is_text() const { return of(json_).is_string(); }
bool JsonValue::is_number() const { return of(json_).is_number(); }
bool JsonValue::is_boolean() const { return of(json_).is_boolean(); }

std::size_t JsonValue::size() const {
  if (!is_list()) throw error("a list");
  return of(json_).size();
}

std::vector<std::string> JsonValue::keys() const {
  if (!is_object()) throw error("an object");
  std::vector<std::string> keys;
  for (const auto& item : of(json_).items()) keys.push_back(item.key());
  return keys;
}

bool JsonValue::boolean() const { return single<bool>(*this, json_); }
double JsonValue::number() const { return single<double>(*this, json_); }
double JsonValue::number_or_nan() const {
  return is_null() ? std::numeric_limits<double>::quiet_NaN() : number();
}
std::size_t JsonValue::count() const { return single<std::size_t>(*this, json_); }
std::int64_t JsonValue::integer() const { return single<std::int64_t>(*this, json_); }
int JsonValue::small_integer() const {
  const std::int64_t value = integer();
  if (!std::in_range<int>(value)) throw error("a whole number up to 2e9");
  return static_cast<int>(value);
}
std::string JsonValue::text() const { return single<std::string>(*this, json_); }

template <typename Value>
std::vector<Value> JsonValue::list(const std::string& expected) const {
  std::vector<Value> values;
  values.reserve(size());
  for (const Json& element : of(json_)) {
    if (!holds<Value>(element)) throw(*this)[values.size()].error(expected);
    values.push_back(element.get<Value>());
  }
  return values;
}

std::vector<double> JsonValue::numbers() const { return list<double>(name_of<double>()); }
std::vector<std::size_t> JsonValue::counts() const {
  return list<std::size_t>(name_of<std::size_t>());
}
std::vector<std::int64_t> JsonValue::integers() const {
  return list<std::int64_t>(name_of<std::int64_t>());
}
std::vector<std::string> JsonValue::texts() const {
  return list<std::string>(name_of<std::string>());
}

std::optional<double> JsonValue::optional_number() const {
  return is_null() ? std::nullopt : std::optional(number());
}
std::optional<std::int64_t> JsonValue::optional_integer() const {
  return is_null() ? std::nullopt : std::optional(integer());
}

std::string JsonValue::json_text() const { return of(json_).dump(); }

InputError JsonValue::error(const std::string& expected) const {
  const Json& json = of(json_);
  constexpr std::size_t kLongest = 60;
  std::string found = json.is_object()  ? "an object"
                      : json.is_array() ? fmt::format("a list of {}", json.size())
                                        : json.dump();
  if (found.size() > kLongest) found = in_quotes(found);
  return error(expected, found);
}

InputError JsonValue::error(const std::string& expected, const std::string& found) const {
  return {document_->file, path_.empty() ? Place::whole_file() : Place::key(path_), expected,
          found};
}

}  // namespace traverse::files
