#include "traverse/files/digest.hpp"

#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"

#include "temporary_folder.hpp"

namespace traverse::files {
namespace {

using testing::TemporaryFolder;

// FIPS 180-2, appendix B.1.
constexpr const char* kSha256OfAbc =
    "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";

TEST(Digest, MatchesTheStandardsExample) {
  const TemporaryFolder folder;
  write_text(folder / "abc", "abc");
  EXPECT_EQ(sha256_of_text("abc"), kSha256OfAbc);
  EXPECT_EQ(sha256_of_file(folder / "abc"), kSha256OfAbc);
  EXPECT_EQ(content_id(folder / "abc").bytes, 3U);
  EXPECT_THROW(sha256_of_file(folder / "none"), InputError);
}

TEST(Digest, OfAFolderIsThatOfItsSortedSha256sumList) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "b");
  write_text(folder / "b/2", "abc");
  write_text(folder / "a", "abc");
  const ContentId id = content_id(folder.path());
  EXPECT_EQ(id.bytes, 6U);
  const std::string line = kSha256OfAbc;
  EXPECT_EQ(id.sha256, sha256_of_text(line + "  a\n" + line + "  b/2\n"));
}

}  // namespace
}  // namespace traverse::files
