#include "decimal_integers.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace traverse::app {
namespace {

struct Numbers {
  std::size_t first = 0;
  std::optional<std::size_t> last;
  int threads = 1;
  std::string file;
  bool quiet = false;
};

Numbers parsed(std::vector<std::string> words) {
  Numbers numbers;
  CLI::App app;
  CLI::App* command = app.add_subcommand("run");
  command->add_option("--first", numbers.first)->capture_default_str();
  command->add_option("--last", numbers.last);
  command->add_option("--threads", numbers.threads)->check(CLI::Range(1, 256));
  command->add_option("--file", numbers.file);
  command->add_flag("!--no-quiet,--quiet", numbers.quiet);
  read_integers_as_decimal(app);
  words.insert(words.begin(), "run");
  std::reverse(words.begin(), words.end());
  app.parse(words);
  return numbers;
}

TEST(DecimalIntegers, LeadingZerosAreNotOctal) {
  EXPECT_EQ(parsed({"--first", "010"}).first, 10U);
  EXPECT_EQ(parsed({"--first", "000008"}).first, 8U);
  EXPECT_EQ(parsed({"--last", "000100"}).last, 100U);
  EXPECT_EQ(parsed({"--threads", "012"}).threads, 12);
  EXPECT_EQ(parsed({"--first", "0"}).first, 0U);
}

TEST(DecimalIntegers, OtherOptionsAreLeftAlone) {
  EXPECT_EQ(parsed({"--file", "010"}).file, "010");
  EXPECT_TRUE(parsed({"--quiet"}).quiet);
}

TEST(DecimalIntegers, OtherFormsAreWrongUsage) {
  for (const char* text : {"0x10", "1e3", "ten", ""}) {
    EXPECT_THROW(parsed({"--first", text}), CLI::ParseError) << text;
  }
  EXPECT_THROW(parsed({"--first", "-1"}), CLI::ParseError);
  EXPECT_THROW(parsed({"--threads", "0300"}), CLI::ParseError) << "300 is above the range";
}

}  // namespace
}  // namespace traverse::app
