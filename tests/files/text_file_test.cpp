#include "traverse/files/text_file.hpp"

#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/binary_file.hpp"

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

TEST(ReadBytes, GivesEveryByteOrSaysWhy) {
  const TemporaryFolder folder;
  write_text(folder / "a.bin", std::string("a\0\r\n\x1a", 5));
  const std::vector<std::byte> bytes = read_bytes(folder / "a.bin");
  ASSERT_EQ(bytes.size(), 5U);
  EXPECT_EQ(bytes[4], std::byte{0x1a});
  EXPECT_THROW(read_bytes(folder / "none.bin"), InputError);
  EXPECT_THROW(read_bytes(folder.path()), InputError);
}

TEST(LineReader, SaysWhatIsWrongWithTheFile) {
  const TemporaryFolder folder;
  EXPECT_THROW(LineReader(folder / "none.txt"), InputError);
  EXPECT_THROW(LineReader(folder.path()), InputError);
  EXPECT_THROW(read_text(folder / "none.txt"), InputError);
}

}  // namespace
}  // namespace traverse::files
