#include "plan/recordings.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "batch/made_plan.hpp"
#include "plan/program_id.hpp"

namespace traverse::batch {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::TemporaryFolder;

class RecordingDigest : public ::testing::Test {
 protected:
  RecordingDigest() {
    folder_.prepare();
    fs::create_directories(temporary_ / "drive/velodyne");
    files::write_text(temporary_ / "drive/velodyne/0.bin", "points");
    files::write_text(temporary_ / "a.rawlog", "rawlog");
    files::write_text(temporary_ / "truth.tum", "truth");
    plan_ = plan_of(temporary_,
                    "recordings:\n  - drive\n  - {path: a.rawlog, reference: truth.tum}\n"
                    "pipelines: [floam]\n");
  }

  RecordingDigests digests() {
    read_.clear();
    return digest_recordings(plan_, folder_,
                             [&](const std::string& name) { read_.push_back(name); });
  }

  TemporaryFolder temporary_;
  BatchFolder folder_{temporary_ / "out"};
  Plan plan_;
  std::vector<std::string> read_;
};

TEST_F(RecordingDigest, IsReadOnceAndKnownAfterwards) {
  const RecordingDigests first = digests();
  EXPECT_THAT(read_, ElementsAre("drive", "a"));
  EXPECT_EQ(digests(), first);
  EXPECT_THAT(read_, IsEmpty());
}

TEST_F(RecordingDigest, ChangesWithEachFileThatBelongsToTheRecording) {
  const RecordingDigests first = digests();
  const auto changed = [&](const std::string& file, const std::string& recording) {
    const RecordingDigests before = digests();
    files::write_text(temporary_ / file, "other content of " + file);
    const RecordingDigests now = digests();
    for (const auto& [name, digest] : now) {
      EXPECT_EQ(digest != before.at(name), name == recording) << file << " and " << name;
    }
  };
  changed("drive/velodyne/0.bin", "drive");
  changed("drive/velodyne/1.bin", "drive");
  changed("a.rawlog", "a");
  changed("a.traverse.yaml", "a");
  changed("truth.tum", "a");
}

TEST_F(RecordingDigest, IsOfTheContentAndNotOfTheTime) {
  const RecordingDigests first = digests();
  fs::last_write_time(temporary_ / "a.rawlog",
                      fs::file_time_type::clock::now() + std::chrono::hours(1));
  EXPECT_EQ(digests(), first);
  EXPECT_THAT(read_, ElementsAre("a"));
}

TEST(ProgramId, HoldsVersionAndCommit) {
  EXPECT_THAT(program_id("/bin/sh", TRAVERSE_SHARE_DIR), ::testing::StartsWith("traverse "));
}

}  // namespace
}  // namespace traverse::batch
