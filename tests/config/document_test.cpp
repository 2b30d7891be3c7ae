#include "traverse/config/document.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/input_error.hpp"

#include "config/example_options.hpp"

namespace traverse::config {
namespace {

using files::InputError;
using ::testing::ElementsAre;

std::string message_of(const std::string& yaml) {
  ExampleOptions options;
  try {
    read(Document::parse(yaml, "x.yaml"), binding(options));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Document, SetsWhatItHasAndLeavesTheRest) {
  ExampleOptions options;
  read(Document::parse("threshold: 0.25\nform: scalar\nangles: [3, 4.5]\ninner: {gate_m: 2}\n"
                       "deskew: false\nlabel: b c\n",
                       "x.yaml"),
       binding(options));
  EXPECT_EQ(options.threshold, 0.25);
  EXPECT_EQ(options.form, Form::kScalar);
  EXPECT_THAT(options.angles, ElementsAre(3, 4.5));
  EXPECT_EQ(options.inner_gate_m, 2);
  EXPECT_FALSE(options.deskew);
  EXPECT_EQ(options.label, "b c");
  EXPECT_EQ(options.count, 3);
}

TEST(Document, NamesFileLineKeyAndFindingOfAWrongValue) {
  EXPECT_EQ(message_of("count: 1\nthreshold: 1.5\n"),
            "x.yaml, line 2: expected a number, 0 .. 1, for 'threshold', found '1.5'");
  EXPECT_EQ(message_of("inner:\n  gate_m: 0\n"),
            "x.yaml, line 2: expected a number, above 0, for 'inner.gate_m', found '0'");
  EXPECT_EQ(message_of("form: round"),
            "x.yaml, line 1: expected one of vector, scalar for 'form', found 'round'");
  EXPECT_EQ(message_of("deskew: 1"),
            "x.yaml, line 1: expected true or false for 'deskew', found '1'");
  EXPECT_EQ(message_of("count: 1.5"),
            "x.yaml, line 1: expected a whole number, 0 or more, for 'count', found '1.5'");
  EXPECT_EQ(message_of("threshold: nan"),
            "x.yaml, line 1: expected a number, 0 .. 1, for 'threshold', found 'nan'");
  EXPECT_EQ(message_of("angles: [1, x]"),
            "x.yaml, line 1: expected a list of numbers only for 'angles', found '[1, x]'");
  EXPECT_EQ(message_of("inner: 3"), "x.yaml, line 1: expected a mapping for 'inner', found '3'");
  EXPECT_EQ(message_of("threshold: {a: 1}"),
            "x.yaml, line 1: expected one value for 'threshold', found a mapping");
}

TEST(Document, HintsAtTheNearestKey) {
  EXPECT_EQ(message_of("\ntreshold: 0.1\n"),
            "x.yaml, line 2: expected a known key (did you mean 'threshold'?), found 'treshold'");
  EXPECT_EQ(message_of("inner: {velocity: 1}"),
            "x.yaml, line 1: expected a known key (gate_m), found 'inner.velocity'");
}

TEST(Document, RefusesBrokenYamlAndTwiceTheSameKey) {
  EXPECT_THAT(message_of("a: [1, 2\nb: 3"), ::testing::StartsWith("x.yaml, line "));
  EXPECT_EQ(message_of("count: 1\ncount: 2"),
            "x.yaml, line 2: expected each key once, found 'count' again");
  EXPECT_THAT(message_of("- 1\n- 2"), ::testing::HasSubstr("a mapping of keys to values"));
  EXPECT_EQ(message_of(""), "no error");
}

TEST(Document, OverlayAndSetWinKeyByKey) {
  Document document = Document::parse("threshold: 0.1\ninner: {gate_m: 5}\n", "base.yaml");
  document.overlay(Document::parse("count: 9", "top.yaml"));
  document.set("inner.gate_m=7");
  document.set("angles=[8]");
  ExampleOptions options;
  read(document, binding(options));
  EXPECT_EQ(options.threshold, 0.1);
  EXPECT_EQ(options.count, 9);
  EXPECT_EQ(options.inner_gate_m, 7);
  EXPECT_THAT(options.angles, ElementsAre(8));
}

TEST(Document, ABadOverrideNamesItself) {
  Document document;
  EXPECT_THROW(document.set("threshold"), InputError);
  document.set("threshold=x");
  ExampleOptions options;
  try {
    read(document, binding(options));
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "--set threshold=x: expected a number, 0 .. 1, for 'threshold', found 'x'");
  }
}

TEST(Document, ScalarIsAPlainValueOfTheTopLevelOnly) {
  const Document document =
      Document::parse("label: x y\ninner: {gate_m: 5}\nlist: [1]\n", "x.yaml");
  EXPECT_EQ(document.scalar("label"), "x y");
  EXPECT_FALSE(document.scalar("inner"));
  EXPECT_FALSE(document.scalar("list"));
  EXPECT_FALSE(document.scalar("gate_m"));
}

TEST(Document, KnowsWhereEachKeyWasGiven) {
  Document document = Document::parse("count: 1\ninner:\n  gate_m: 5\nlabel: x\n", "a.yaml");
  document.overlay(Document::parse("\nlabel: y\n", "b.yaml"));
  document.set("inner.gate_m=7", "--option");
  EXPECT_EQ(to_text(*document.origin("count")), "a.yaml, line 1");
  EXPECT_EQ(to_text(*document.origin("label")), "b.yaml, line 2");
  EXPECT_EQ(to_text(*document.origin("inner.gate_m")), "--option inner.gate_m=7");
  EXPECT_FALSE(document.origin("inner.none"));
  EXPECT_FALSE(document.origin("none.gate_m"));
}

TEST(Document, ChildIsTheMappingBelowAKey) {
  const Document document = Document::parse("inner: {gate_m: 5}\nlabel: x\n", "x.yaml");
  EXPECT_THAT(document.keys(), ElementsAre("inner", "label"));
  EXPECT_THAT(document.child("inner").keys(), ElementsAre("gate_m"));
  EXPECT_TRUE(document.child("none").keys().empty());
  EXPECT_THROW(document.child("label"), InputError);
}

TEST(Document, ItemsOfAListAreMappingsWithTheirPlaces) {
  const Document document =
      Document::parse("drives:\n  - a.rawlog\n  - path: b\n    first: 3\nlabel: x\n", "x.yaml");
  const auto items = document.items("drives", "path");
  ASSERT_EQ(items.size(), 2U);
  EXPECT_EQ(items[0].scalar("path"), "a.rawlog");
  EXPECT_EQ(to_text(items[0].origin()), "x.yaml, line 2");
  EXPECT_EQ(items[1].scalar("first"), "3");
  EXPECT_EQ(to_text(items[1].origin()), "x.yaml, line 3");
  EXPECT_EQ(to_text(*items[1].origin("first")), "x.yaml, line 4");
  EXPECT_TRUE(document.items("none", "path").empty());
  EXPECT_THROW(document.items("label", "path"), InputError);
}

TEST(Document, LeavesAreTheSameNestedOrWithDots) {
  const Document document = Document::parse(
      "solver:\n  huber_m: [0.1, 0.2]\nsolver.line_residual: vector\nempty: []\n", "x.yaml");
  const auto leaves = document.leaves();
  ASSERT_EQ(leaves.size(), 3U);
  EXPECT_EQ(leaves[0].path, "solver.huber_m");
  EXPECT_EQ(leaves[0].text, "[0.1, 0.2]");
  EXPECT_THAT(leaves[0].items.value(), ElementsAre("0.1", "0.2"));
  EXPECT_EQ(to_text(leaves[0].origin), "x.yaml, line 2");
  EXPECT_EQ(leaves[1].path, "solver.line_residual");
  EXPECT_EQ(leaves[1].text, "vector");
  EXPECT_FALSE(leaves[1].items);
  EXPECT_TRUE(leaves[2].items.value().empty());
}

TEST(Document, KeysThatAreReadElsewhereAreKnown) {
  const Document document = Document::parse("count: 3\ndrives: [a]\n", "x.yaml");
  std::int64_t count = 0;
  const auto bind = [&](Binder& b) { b.integer("count", count, Range::any(), "how many"); };
  static constexpr std::array<std::string_view, 1> kOthers{"drives"};
  read(document, bind, kOthers);
  EXPECT_EQ(count, 3);
  EXPECT_THROW(read(document, bind), InputError);
}

}  // namespace
}  // namespace traverse::config
