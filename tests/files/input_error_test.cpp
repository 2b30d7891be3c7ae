#include "traverse/files/input_error.hpp"

#include <string>

#include <gtest/gtest.h>

namespace traverse::files {
namespace {

TEST(InputError, NamesFilePlaceExpectationAndFinding) {
  const InputError error("times.txt", Place::line(12), "a number of seconds", in_quotes("abc"));
  EXPECT_STREQ(error.what(), "times.txt, line 12: expected a number of seconds, found 'abc'");
  EXPECT_STREQ(InputError("a.bin", Place::whole_file(), "points", "none").what(),
               "a.bin: expected points, found none");
}

TEST(InQuotes, ShowsControlCharactersAndShortensLongText) {
  EXPECT_EQ(in_quotes("a\x1b[2J\n"), "'a\\x1b[2J\\x0a'");
  EXPECT_EQ(in_quotes(std::string(100, 'x')), "'" + std::string(60, 'x') + "...'");
}

}  // namespace
}  // namespace traverse::files
