#include "traverse/files/sealed_json.hpp"

#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/digest.hpp"
#include "traverse/files/input_error.hpp"

namespace traverse::files {
namespace {

using ::testing::HasSubstr;

constexpr const char* kJson = "{\n \"frames\": 12,\n \"name\": \"drive\"\n}\n";

std::string error_of(const std::string& text) {
  try {
    return require_seal(text, "run.json") ? "" : "no seal";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(SealedJson, IsAsItWasOrAnError) {
  const std::string sealed = sealed_json(kJson);
  EXPECT_EQ(error_of(sealed), "");
  EXPECT_EQ(error_of(kJson), "no seal");
  for (std::size_t i = 0; i < sealed.size(); ++i) {
    std::string changed = sealed;
    changed[i] = changed[i] == '7' ? '8' : '7';
    // In the name of the key itself it is as if there were none.
    const std::string error = error_of(changed);
    EXPECT_THAT(error, ::testing::AnyOf(HasSubstr("run.json"), "no seal")) << i;
    EXPECT_TRUE(error != "no seal" || (i > 2 && i < 26)) << i;
  }
  EXPECT_THAT(error_of(sealed.substr(0, sealed.size() - 1)), HasSubstr("edited"));
  EXPECT_THAT(error_of(sealed + "\n"), HasSubstr("edited"));
}

TEST(SealedJson, CanBeRepeatedByOtherPrograms) {
  const std::string sealed = sealed_json(kJson);
  const std::size_t begin = sealed.find('\n') + 1;
  const std::size_t end = sealed.find('\n', begin) + 1;
  std::string others = sealed;  // grep -v sha256_of_other_lines
  EXPECT_THAT(others.substr(begin, end - begin), HasSubstr(kSealKey));
  others.erase(begin, end - begin);
  EXPECT_EQ(others, kJson);
  EXPECT_THAT(sealed, HasSubstr(sha256_of_text(others)));
}

TEST(SealedJson, OtherLayoutIsAnEdit) {
  EXPECT_THAT(error_of("{\"sha256_of_other_lines\": \"12\", \"frames\": 12}"),
              HasSubstr("another form"));
  EXPECT_THROW(sealed_json("[1]"), std::invalid_argument);
}

}  // namespace
}  // namespace traverse::files
