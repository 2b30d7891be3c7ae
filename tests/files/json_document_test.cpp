#include "traverse/files/json_document.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "temporary_folder.hpp"

namespace traverse::files {
namespace {

template <typename Read>
std::string message_of(const std::string& text, const Read& read) {
  try {
    const auto document = JsonDocument::parse(text, "a.json");
    read(document.root());
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

void nothing(const JsonValue& /*json*/) {}

std::string nested(std::size_t levels) {
  return std::string(levels, '[') + std::string(levels, ']');
}

TEST(JsonDocument, GivesValuesOfEveryKind) {
  const auto document = JsonDocument::parse(
      R"({"b": true, "n": -2.5, "c": 3, "i": -4, "t": "ü", "l": [1, 2], "e": null, "o": {"x": 1}})");
  const JsonValue json = document.root();
  EXPECT_TRUE(json["b"].boolean());
  EXPECT_EQ(json["n"].number(), -2.5);
  EXPECT_EQ(json["c"].count(), 3U);
  EXPECT_EQ(json["i"].small_integer(), -4);
  EXPECT_EQ(json["t"].text(), "ü");
  EXPECT_EQ(json["l"].counts(), (std::vector<std::size_t>{1, 2}));
  EXPECT_EQ(json["l"][1].integer(), 2);
  EXPECT_TRUE(std::isnan(json["e"].number_or_nan()));
  EXPECT_FALSE(json["e"].optional_number());
  EXPECT_EQ(json["o"].keys(), std::vector<std::string>{"x"});
  EXPECT_FALSE(json.has("x"));
  EXPECT_EQ(json["l"].json_text(), "[1,2]");
}

TEST(JsonDocument, NamesTheKeyOfWhatIsWrong) {
  const std::string text = R"({"a": {"b": [1, -2, "x"]}, "big": 9223372036854775808})";
  EXPECT_EQ(message_of(text, [](const auto& json) { json["a"]["c"].number(); }),
            "a.json, key a.c: expected a value, found none");
  EXPECT_EQ(message_of(text, [](const auto& json) { json["a"]["b"].number(); }),
            "a.json, key a.b: expected a number, found a list of 3");
  EXPECT_EQ(message_of(text, [](const auto& json) { json["a"]["b"].counts(); }),
            "a.json, key a.b.1: expected a count, found -2");
  EXPECT_EQ(message_of(text, [](const auto& json) { json["a"]["b"].numbers(); }),
            "a.json, key a.b.2: expected a number, found \"x\"");
  EXPECT_EQ(message_of(text, [](const auto& json) { json["a"]["b"][3].number(); }),
            "a.json, key a.b: expected a list of 4 and more, found a list of 3");
  EXPECT_EQ(message_of(text, [](const auto& json) { json["big"].integer(); }),
            "a.json, key big: expected a whole number, found 9223372036854775808");
  EXPECT_EQ(message_of("3", [](const auto& json) { json["a"].number(); }),
            "a.json, key a: expected a value, found none");
}

TEST(JsonDocument, NamesTheLineThatIsNoJson) {
  EXPECT_EQ(message_of("", nothing), "a.json, line 1: expected JSON, found its end");
  EXPECT_EQ(message_of("{\n \"a\": 1,\n", nothing), "a.json, line 3: expected JSON, found its end");
  EXPECT_EQ(message_of("{\n \"a\": x}\n", nothing),
            "a.json, line 2: expected JSON, found ' \"a\": x}'");
  EXPECT_EQ(message_of("[1e999]", nothing),
            "a.json: expected numbers up to 1.8e308, found a larger one");
}

TEST(JsonDocument, NestingHasALimitAndNoStackOverflows) {
  EXPECT_EQ(message_of(nested(JsonDocument::kMostLevels), nothing), "no error");
  const std::string expected =
      "a.json, line 1: expected JSON of at most 64 levels, found more objects and lists within "
      "each other";
  EXPECT_EQ(message_of(nested(JsonDocument::kMostLevels + 1), nothing), expected);
  EXPECT_EQ(message_of(nested(1'000'000), nothing), expected);
  EXPECT_EQ(message_of(std::string(1'000'000, '['), nothing), expected);
  std::string objects;
  for (int k = 0; k < 100'000; ++k) objects += "{\"a\":";
  EXPECT_EQ(message_of(objects, nothing), expected);
  EXPECT_EQ(
      message_of("\"" + std::string(100, '[') + "\\\"" + std::string(100, '[') + "\"", nothing),
      "no error")
      << "brackets in a text are none";
}

TEST(JsonDocument, AFileThatIsNotThereIsNamed) {
  const testing::TemporaryFolder folder;
  try {
    JsonDocument::read(folder / "none.json");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.file(), folder / "none.json");
  }
}

}  // namespace
}  // namespace traverse::files
