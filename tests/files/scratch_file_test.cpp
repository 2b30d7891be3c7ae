#include "traverse/files/scratch_file.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "traverse/files/input_error.hpp"

#include "file_size_limit.hpp"
#include "temporary_folder.hpp"

namespace traverse::files {
namespace {

using testing::TemporaryFolder;

std::vector<std::byte> bytes_of(std::size_t count, int value) {
  return std::vector<std::byte>(count, static_cast<std::byte>(value));
}

TEST(ScratchFile, GivesBackWhatWasAppendedAndHasNoName) {
  const TemporaryFolder folder;
  ScratchFile file(folder / "");
  EXPECT_TRUE(std::filesystem::is_empty(folder / ""));
  EXPECT_EQ(file.append(bytes_of(3, 1)), 0U);
  EXPECT_EQ(file.append(bytes_of(5, 2)), 3U);
  std::vector<std::byte> read(5);
  file.read(3, read);
  EXPECT_EQ(read, bytes_of(5, 2));
  EXPECT_THROW(file.read(4, read), OutputError);
}

TEST(ScratchFile, TellsWhenThereIsNoRoom) {
  const TemporaryFolder folder;
  EXPECT_THROW(ScratchFile(folder / "nowhere"), OutputError);
  ScratchFile file(folder / "");
  const testing::FileSizeLimit limit(1000);
  EXPECT_THROW(file.append(bytes_of(2000, 1)), OutputError);
}

}  // namespace
}  // namespace traverse::files
