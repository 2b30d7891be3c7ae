#include "traverse/replay/script.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"

#include "temporary_folder.hpp"

namespace traverse::replay {
namespace {

std::string error_of(const std::string& text) {
  const testing::TemporaryFolder folder;
  files::write_text(folder / "script", text);
  try {
    read_script(folder / "script");
  } catch (const files::InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Script, IsACommandALine) {
  const testing::TemporaryFolder folder;
  files::write_text(folder / "script", "# begin\n\nplay\n  seek   1:02.5  # there\nrange 3 9\n");
  const auto commands = read_script(folder / "script");
  ASSERT_EQ(commands.size(), 3U);
  EXPECT_EQ(commands[0].name, "play");
  EXPECT_EQ(commands[0].argument, "");
  EXPECT_EQ(commands[1].argument, "1:02.5");
  EXPECT_EQ(commands[1].line, 4U);
  EXPECT_EQ(commands[2].argument, "3 9");
}

TEST(Script, NamesTheLineThatIsWrong) {
  using ::testing::HasSubstr;
  EXPECT_THAT(error_of("play\nfly\n"), HasSubstr("line 2: expected a command"));
  EXPECT_THAT(error_of("seek\n"), HasSubstr("line 1: expected seek PLACE, found 'seek'"));
  EXPECT_THAT(error_of("play now\n"), HasSubstr("expected play alone, found 'play now'"));
  EXPECT_EQ(error_of(""), "no error");
}

}  // namespace
}  // namespace traverse::replay
