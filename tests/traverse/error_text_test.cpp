#include "error_text.hpp"

#include <limits>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace traverse::app {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

template <typename Work>
std::string text_of(const Work& work) {
  try {
    work();
  } catch (...) {
    return error_text("traverse report");
  }
  return "no error";
}

TEST(ErrorText, OwnMessagesStay) {
  EXPECT_EQ(text_of([] { throw std::runtime_error("no such scan"); }), "no such scan");
}

TEST(ErrorText, LackOfMemoryIsSaidInWords) {
  EXPECT_THAT(text_of([] { throw std::bad_alloc(); }),
              AllOf(HasSubstr("out of memory"), HasSubstr("`traverse report`"),
                    Not(HasSubstr("bad_alloc"))));
  EXPECT_THAT(
      text_of([] { std::vector<int>().reserve(std::numeric_limits<std::size_t>::max() / 2); }),
      AllOf(HasSubstr("out of memory"), Not(HasSubstr("vector"))));
}

TEST(ErrorText, JsonIsSaidInWords) {
  EXPECT_THAT(text_of([] { const auto json = nlohmann::json::parse("{\"a\": "); }),
              AllOf(HasSubstr("a JSON file that `traverse report` read"),
                    Not(HasSubstr("[json.exception"))));
  EXPECT_THAT(text_of([] { throw 1; }), HasSubstr("without a reason"));
}

}  // namespace
}  // namespace traverse::app
