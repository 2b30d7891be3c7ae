#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "traverse/files/input_error.hpp"

namespace traverse::files {

class JsonValue;

/// A JSON file that may be damaged or somebody else's. What is wrong with it is told as an
/// InputError that names the file and the key, never as an exception of the JSON library.
class JsonDocument {
 public:
  /// Objects and lists within each other: deeper ones are nobody's data, and code that follows
  /// them by recursion would overflow its stack.
  static constexpr std::size_t kMostLevels = 64;

  /// \throws InputError if the file cannot be read, or as parse()
  static JsonDocument read(const std::filesystem::path& file);
  /// \param file for messages \throws InputError naming the line if it is no JSON, has a number
  /// that no double holds, or is nested deeper than kMostLevels
  static JsonDocument parse(std::string_view text, const std::filesystem::path& file = {});

  JsonDocument(JsonDocument&&) noexcept;
  JsonDocument& operator=(JsonDocument&&) noexcept;
  ~JsonDocument();

  /// Valid as long as the document.
  JsonValue root() const;

 private:
  struct Content;
  friend class JsonValue;
  explicit JsonDocument(std::unique_ptr<const Content> content);

  std::unique_ptr<const Content> content_;
};

/// A value of a document that knows which keys lead to it. Every function but the questions throws
/// InputError for a value of another kind.
class JsonValue {
 public:
  /// A member that must be there.
  JsonValue operator[](std::string_view key) const;
  /// An element of a list, from 0, that must be there.
  JsonValue operator[](std::size_t index) const;

  bool has(std::string_view key) const;  ///< is an object with that member, which may be null
  bool is_null() const;
  bool is_object() const;
  bool is_list() const;
  bool is_text() const;
  bool is_number() const;
  bool is_boolean() const;

  std::size_t size() const;               ///< of a list
  std::vector<std::string> keys() const;  ///< of an object, in the order of the file

  bool boolean() const;
  double number() const;
  double number_or_nan() const;  ///< null: NaN, as it is written
  std::size_t count() const;     ///< a whole number that is not negative
  std::int64_t integer() const;
  int small_integer() const;  ///< that an int holds
  std::string text() const;

  std::vector<double> numbers() const;
  std::vector<std::size_t> counts() const;
  std::vector<std::int64_t> integers() const;
  std::vector<std::string> texts() const;

  std::optional<double> optional_number() const;         ///< nothing: null
  std::optional<std::int64_t> optional_integer() const;  ///< nothing: null

  /// The value as JSON on one line.
  std::string json_text() const;

  /// That this value is not what was expected, to be thrown.
  InputError error(const std::string& expected) const;
  InputError error(const std::string& expected, const std::string& found) const;

 private:
  friend class JsonDocument;
  JsonValue(const JsonDocument::Content& document, const void* json, std::string path)
      : document_(&document), json_(json), path_(std::move(path)) {}
  template <typename Value>
  std::vector<Value> list(const std::string& expected) const;

  const JsonDocument::Content* document_;
  const void* json_;  // of the JSON library, which stays in one source
  std::string path_;  // "ape.full.rmse"
};

}  // namespace traverse::files
