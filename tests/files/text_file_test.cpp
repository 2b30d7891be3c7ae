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

TEST(LineReader, GivesLinesOfAnyUsualLengthAndRefusesLongerOnes) {
  const TemporaryFolder folder;
  for (const std::size_t length : {4094U, 4095U, 4096U, 8190U, 8191U, 100'000U}) {
    write_text(folder / "a.txt", std::string(length, 'x') + "\n\ny");
    LineReader reader(folder / "a.txt");
    ASSERT_TRUE(reader.next());
    EXPECT_EQ(reader.line(), std::string(length, 'x'));
    ASSERT_TRUE(reader.next());
    EXPECT_EQ(reader.line(), "y");
    EXPECT_EQ(reader.number(), 3U);
    EXPECT_FALSE(reader.next());
  }
  write_text(folder / "b.txt", "x\n" + std::string(LineReader::kLongestLine + 5000, 'x') + "\n");
  LineReader reader(folder / "b.txt");
  ASSERT_TRUE(reader.next());
  try {
    reader.next();
    FAIL() << "the line is not refused";
  } catch (const InputError& error) {
    EXPECT_EQ(error.place().text, "line 2");
  }
}

TEST(ReadText, RefusesWhatIsTooLargeToBeReadAtOnce) {
  const TemporaryFolder folder;
  write_text(folder / "a.bin", "");
  std::filesystem::resize_file(folder / "a.bin", kMostBytesAtOnce + 1);  // takes no room
  EXPECT_THROW(read_bytes(folder / "a.bin"), InputError);
}

}  // namespace
}  // namespace traverse::files
