#include "traverse/pipeline/recording_place.hpp"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/json_document.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/pipeline/run_digests.hpp"
#include "traverse/pipeline/run_folder.hpp"
#include "traverse/pipeline/run_record.hpp"

#include "temporary_folder.hpp"

namespace traverse::pipeline {
namespace {

namespace fs = std::filesystem;

/// PARENT/data/drive.rawlog and PARENT/results/run.
class PlaceOfRecording : public ::testing::Test {
 protected:
  PlaceOfRecording() {
    fs::create_directories(parent_ / "data");
    fs::create_directories(run_.path);
    files::write_text(recording_, "bytes");
    record_.recording.path = recording_;
    record_.place = run_.path;
    write_record(run_, record_);
  }

  static fs::path found(const RunFolder& folder) {
    const auto record = files::JsonDocument::read(folder.record());
    return find_recording(folder, record.root());
  }

  testing::TemporaryFolder parent_;
  fs::path recording_ = parent_ / "data/drive.rawlog";
  RunFolder run_{parent_ / "results/run"};
  RunRecord record_;
};

TEST_F(PlaceOfRecording, IsToldInTwoWays) {
  const RecordingPlace place = recording_place(recording_, run_.path);
  EXPECT_EQ(place.path, recording_);
  EXPECT_EQ(place.from_run, "../../data/drive.rawlog");
  EXPECT_EQ(found(run_), recording_);
}

TEST_F(PlaceOfRecording, HoldsWhenBothMoveAndWhenOneDoes) {
  fs::rename(parent_ / "results/run", parent_ / "run");
  EXPECT_EQ(found({parent_ / "run"}), recording_) << "the run alone";
  fs::create_directory(parent_ / "elsewhere");
  fs::rename(parent_ / "data", parent_ / "elsewhere/data");
  fs::create_directory(parent_ / "elsewhere/results");
  fs::rename(parent_ / "run", parent_ / "elsewhere/results/renamed");
  EXPECT_EQ(found({parent_ / "elsewhere/results/renamed"}),
            parent_ / "elsewhere/data/drive.rawlog");
  fs::remove(parent_ / "elsewhere/data/drive.rawlog");
  EXPECT_EQ(found({parent_ / "elsewhere/results/renamed"}), recording_) << "where it was";
}

TEST_F(PlaceOfRecording, ALinkLeadsToTheRun) {
  fs::create_directory(parent_ / "links");
  fs::create_directory_symlink(parent_ / "results", parent_ / "links/results");
  EXPECT_EQ(recording_place(recording_, parent_ / "links/results/run").from_run,
            "../../data/drive.rawlog");
  record_.recording.path = parent_ / "nowhere/drive.rawlog";
  write_record(run_, record_);
  fs::rename(parent_ / "data", parent_ / "nowhere");
  EXPECT_EQ(found({parent_ / "links/results/run"}), parent_ / "nowhere/drive.rawlog");
}

TEST_F(PlaceOfRecording, IsToldAnewForAFolderThatGetsAnotherPlace) {
  retell_place(run_, run_.path, parent_ / "run");
  require_as_written(run_, {run_.record()});
  fs::rename(run_.path, parent_ / "run");
  fs::create_directory(parent_ / "moved");
  for (const char* name : {"data", "run"}) fs::rename(parent_ / name, parent_ / "moved" / name);
  EXPECT_EQ(found({parent_ / "moved/run"}), parent_ / "moved/data/drive.rawlog");
}

TEST_F(PlaceOfRecording, NothingIsToldAnewOfWhatIsNoRun) {
  files::write_text(run_.record(), "{\"half\": ");
  retell_place(run_, run_.path, parent_ / "run");
  EXPECT_EQ(files::read_text(run_.record()), "{\"half\": ");
  fs::remove(run_.record());
  retell_place(run_, run_.path, parent_ / "run");
  EXPECT_FALSE(fs::exists(run_.record()));
}

}  // namespace
}  // namespace traverse::pipeline
