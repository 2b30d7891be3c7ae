#include "traverse/files/text_file.hpp"

#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"

#include "temporary_folder.hpp"

namespace traverse::files {
namespace {

using testing::TemporaryFolder;

TEST(LineReader, SkipsCommentsAndBlanksAndCountsEveryLine) {
  const TemporaryFolder folder;
  write_text(folder / "a.txt", "# head\n\n  1 2\r\n \t\n3\n");
  LineReader reader(folder / "a.txt");
  ASSERT_TRUE(reader.next());
  EXPECT_EQ(reader.line(), "  1 2");
  EXPECT_EQ(reader.number(), 3U);
  ASSERT_TRUE(reader.next());
  EXPECT_EQ(reader.number(), 5U);
  EXPECT_EQ(std::string(reader.error("two numbers").what()),
            (folder / "a.txt").string() + ", line 5: expected two numbers, found '3'");
  EXPECT_FALSE(reader.next());
}

TEST(LineReader, SaysWhatIsWrongWithTheFile) {
  const TemporaryFolder folder;
  EXPECT_THROW(LineReader(folder / "none.txt"), InputError);
  EXPECT_THROW(LineReader(folder.path()), InputError);
  EXPECT_THROW(read_text(folder / "none.txt"), InputError);
}

}  // namespace
}  // namespace traverse::files
