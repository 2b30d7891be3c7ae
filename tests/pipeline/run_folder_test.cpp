#include "traverse/pipeline/run_folder.hpp"

#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"

#include "temporary_folder.hpp"

namespace traverse::pipeline {
namespace {

using testing::TemporaryFolder;

TEST(RunFolder, NothingIsWrittenIntoAFolderThatHoldsSomething) {
  const TemporaryFolder parent;
  const RunFolder folder{parent / "some/run"};
  folder.prepare();
  folder.prepare();
  files::write_text(folder.path / "notes.txt", "mine");
  EXPECT_THROW(folder.prepare(), files::OutputError);
  EXPECT_TRUE(std::filesystem::exists(folder.path / "notes.txt"));
}

TEST(RunFolder, KnowsItsPicturesFromTheUsers) {
  for (const char* own : {"map-height.png", "map-height_dark.png", "map-slice-above_print.png",
                          "trajectory-error.svg", "worst-segment-10_dark.png"}) {
    EXPECT_TRUE(RunFolder::is_picture(own)) << own;
  }
  for (const char* foreign :
       {"mine.png", "map-height.txt", "map-height", "map-height_dark_print.png",
        "worst-segment-.png", "worst-segment-1a.png", "my map-height.png", ".png", ""}) {
    EXPECT_FALSE(RunFolder::is_picture(foreign)) << foreign;
  }
}

TEST(RunFolder, AFileInTheWayIsAnError) {
  const TemporaryFolder parent;
  files::write_text(parent / "run", "");
  EXPECT_THROW(RunFolder{parent / "run"}.prepare(), files::OutputError);
}

}  // namespace
}  // namespace traverse::pipeline
