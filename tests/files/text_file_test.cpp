#include "traverse/files/text_file.hpp"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/binary_file.hpp"
#include "traverse/files/json_document.hpp"
#include "traverse/files/text_encoding.hpp"

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

constexpr const char* kMark = "\xEF\xBB\xBF";

TEST(LineReader, AByteOrderMarkIsNoPartOfTheFirstLine) {
  const TemporaryFolder folder;
  for (const std::string text : {"1 2\n3\n", "1 2\r\n3\r\n", "# head\n1 2\n3\n", "1 2"}) {
    write_text(folder / "a.txt", kMark + text);
    LineReader reader(folder / "a.txt");
    ASSERT_TRUE(reader.next());
    EXPECT_EQ(reader.line(), "1 2") << text;
  }
  write_text(folder / "a.txt", kMark);
  EXPECT_FALSE(LineReader(folder / "a.txt").next());
  // Only at the beginning.
  write_text(folder / "a.txt", std::string("1\n") + kMark + "2\n");
  LineReader reader(folder / "a.txt");
  ASSERT_TRUE(reader.next() && reader.next());
  EXPECT_EQ(reader.line(), kMark + std::string("2"));
}

TEST(LineReader, GivesCommentsToWhoAsks) {
  const TemporaryFolder folder;
  write_text(folder / "a.csv", "\n#t,x\n1,2\n");
  LineReader reader(folder / "a.csv");
  ASSERT_TRUE(reader.next(LineReader::Comments::kGive));
  EXPECT_EQ(reader.line(), "#t,x");
  EXPECT_EQ(reader.number(), 2U);
}

TEST(ReadText, LeavesAByteOrderMarkOut) {
  const TemporaryFolder folder;
  write_text(folder / "a.yaml", kMark + std::string("a: 1\n"));
  EXPECT_EQ(read_text(folder / "a.yaml"), "a: 1\n");
  write_text(folder / "a.json", kMark + std::string("{\"a\": 1}"));
  EXPECT_EQ(JsonDocument::read(folder / "a.json").root()["a"].number(), 1);
}

/// ASCII as UTF-16 or UTF-32: a character and NUL bytes after it, or before it.
std::string wide(const std::string& ascii, std::size_t bytes, bool is_little_endian) {
  std::string text;
  for (const char c : ascii) {
    std::string character(bytes, '\0');
    character[is_little_endian ? 0 : bytes - 1] = c;
    text += character;
  }
  return text;
}

TEST(TextEncoding, TextOfOtherEncodingsIsNamedWithTheNextStep) {
  const TemporaryFolder folder;
  const std::string file = (folder / "a.txt").string();
  const std::string ascii = "1700000000.0 1 2 3 0 0 0 1\r\n";
  const std::vector<std::pair<std::string, std::string>> texts{
      {"\xFF\xFE" + wide(ascii, 2, true), "UTF-16LE"},
      {"\xFE\xFF" + wide(ascii, 2, false), "UTF-16BE"},
      {wide(ascii, 2, true), "UTF-16LE"},
      {wide(ascii, 2, false), "UTF-16BE"},
      {std::string("\xFF\xFE\0\0", 4) + wide(ascii, 4, true), "UTF-32LE"},
      {std::string("\0\0\xFE\xFF", 4) + wide(ascii, 4, false), "UTF-32BE"}};
  for (const auto& [text, encoding] : texts) {
    write_text(file, text);
    const std::string message = file + ": expected text in UTF-8 or ASCII, found " +
                                encoding.substr(0, 6) + " text; save it as UTF-8, or: iconv -f " +
                                encoding + " -t UTF-8 " + file + " > COPY";
    const auto error_of = [](const auto& read) -> std::string {
      try {
        read();
      } catch (const OtherEncoding& error) {
        return error.what();
      }
      return "no error";
    };
    EXPECT_EQ(error_of([&] { LineReader(file).next(); }), message);
    EXPECT_EQ(error_of([&] { read_text(file); }), message);
    EXPECT_EQ(error_of([&] { JsonDocument::read(file); }), message);
  }
}

TEST(TextEncoding, BinaryDataIsNoText) {
  EXPECT_EQ(byte_order_mark(std::string("a\0b", 3), "a"), 0U);  // too short to tell
  EXPECT_EQ(byte_order_mark(std::string("\0\0\0\0\0\0\0\0", 8), "a"), 0U);
  EXPECT_EQ(byte_order_mark(std::string("a\0\0\0b\0\0\0", 8), "a"), 0U);
  EXPECT_EQ(byte_order_mark("", "a"), 0U);
}

TEST(ReadText, RefusesWhatIsTooLargeToBeReadAtOnce) {
  const TemporaryFolder folder;
  write_text(folder / "a.bin", "");
  std::filesystem::resize_file(folder / "a.bin", kMostBytesAtOnce + 1);  // takes no room
  EXPECT_THROW(read_bytes(folder / "a.bin"), InputError);
}

}  // namespace
}  // namespace traverse::files
