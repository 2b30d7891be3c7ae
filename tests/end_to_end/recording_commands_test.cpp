#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "traverse/files/atomic_file.hpp"

#include "dataset/made_recordings.hpp"
#include "end_to_end/program.hpp"

namespace traverse::app {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using namespace traverse::testing;  // made recordings, running the program

class RecordingCommands : public ::testing::Test {
 protected:
  RecordingCommands() { make_kitti_folder(folder_ / "drive", 5); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::vector<std::string> left_in_folder() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }
  TemporaryFolder folder_;
};

TEST_F(RecordingCommands, InfoTellsWhatThereIs) {
  fs::resize_file(folder_ / "drive" / bin_name(2), 17);
  const ProgramResult result = run_program("info " + path("drive"));
  EXPECT_EQ(result.status, 0) << result.messages;
  EXPECT_THAT(result.output, AllOf(HasSubstr("KITTI odometry"), ContainsRegex("velodyne +lidar +4"),
                                   ContainsRegex("motion compensated +yes +scans of the KITTI"),
                                   ContainsRegex("points per scan +200 / 200 / 200"),
                                   HasSubstr("Reference: none"), HasSubstr("Skipped records: 1"),
                                   HasSubstr("velodyne/000002.bin (found 17 bytes)")));
  EXPECT_THAT(result.messages, HasSubstr("reading drive"));  // progress is not output
}

TEST_F(RecordingCommands, InfoWritesTheSameAsJson) {
  const ProgramResult result =
      run_program("info " + path("drive") + " --json " + path("info.json") +
                  " --recording motion_compensated=false --recording name=Test");
  ASSERT_EQ(result.status, 0) << result.messages;
  const auto json = nlohmann::json::parse(files::read_text(folder_ / "info.json"));
  EXPECT_EQ(json["name"], "Test");
  EXPECT_EQ(json["motion_compensated"], false);
  EXPECT_EQ(json["records"], 5);
  EXPECT_EQ(json["sensors"][0]["lidar"]["points"]["max"], 200);
  EXPECT_EQ(json["sensors"][0]["first"], "0.000000000");
  EXPECT_TRUE(json["reference"].is_null());
  EXPECT_TRUE(json["skipped"].empty());
  bool stated = false;
  for (const auto& fact : json["facts"]) {
    stated = stated || fact["reason"] == "--recording motion_compensated=false";
  }
  EXPECT_TRUE(stated);
}

TEST_F(RecordingCommands, InfoListsTheFormats) {
  const ProgramResult result = run_program("info --formats --json " + path("formats.json"));
  ASSERT_EQ(result.status, 0) << result.messages;
  const auto json = nlohmann::json::parse(files::read_text(folder_ / "formats.json"));
  ASSERT_GE(json["formats"].size(), 6U);
  for (const auto& format : json["formats"]) {
    EXPECT_THAT(result.output, HasSubstr(format["name"].get<std::string>()));
    EXPECT_THAT(format["description"].get<std::string>(), ::testing::Not(IsEmpty()));
  }
  EXPECT_THAT(result.output, ContainsRegex("KITTI odometry +a folder with velodyne/\\*.bin"));
  EXPECT_EQ(run_program("info").status, 2) << "a recording or --formats";
  EXPECT_EQ(run_program("info --formats " + path("drive")).status, 2);
}

TEST_F(RecordingCommands, ConvertThereAndBack) {
  ASSERT_EQ(run_program("convert " + path("drive") + " " + path("a.rawlog")).status, 0);
  const ProgramResult back = run_program("convert " + path("a.rawlog") + " " + path("scans") +
                                         " --first 1 --last 3 --format ply");
  EXPECT_EQ(back.status, 0) << back.messages;
  EXPECT_THAT(back.output, HasSubstr("3 scans, 0 other records written"));
  EXPECT_TRUE(fs::exists(folder_ / "scans/000002.ply"));
  EXPECT_FALSE(fs::exists(folder_ / "scans/000003.ply"));
  EXPECT_THAT(run_program("info " + path("scans")).output, ContainsRegex("lidar +lidar +3"));
}

TEST_F(RecordingCommands, TheKittiFormatSaysWhatItLoses) {
  ASSERT_EQ(run_program("convert " + path("drive") + " " + path("scans")).status, 0);
  const ProgramResult result =
      run_program("convert " + path("scans") + " " + path("kitti") + " --format kitti");
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.output, HasSubstr("left out: 5 ring numbers, by scan"));
}

TEST_F(RecordingCommands, FailureIsOneLineAndStatusOne) {
  for (const auto& [arguments, message] :
       {std::pair("info " + path("none"), "none: expected a recording, found no such file"),
        std::pair("info " + path("drive") + " --recording sensr=x", "did you mean 'sensor'?"),
        std::pair("info " + path("drive") + " --recording-config " + path("none.yaml"),
                  "none.yaml: expected a readable file"),
        std::pair("info " + path("drive") + " --json " + path("none/a.json"),
                  "none/a.json: cannot be written"),
        std::pair("convert " + path("drive") + " " + path("drive"), "are the same"),
        std::pair("convert " + path("drive") + " " + path("none/a.rawlog"), "cannot be written"),
        std::pair("convert " + path("drive") + " " + path("out") + " --lidar x",
                  "no lidar 'x' in the recording; there is: 'velodyne'"),
        std::pair("convert " + path("drive") + " " + path("out") + " --first 5",
                  "nothing to convert")}) {
    const ProgramResult result = run_program(arguments);
    EXPECT_EQ(result.status, 1) << arguments;
    EXPECT_THAT(result.messages, HasSubstr("traverse: ")) << arguments;
    EXPECT_THAT(result.messages, HasSubstr(message)) << arguments;
  }
  EXPECT_THAT(left_in_folder(), ::testing::ElementsAre("drive"));
}

TEST_F(RecordingCommands, WrongUsageIsStatusTwo) {
  for (const std::string& arguments :
       {std::string("info"), "info " + path("drive") + " --unknown", "convert " + path("drive"),
        "convert " + path("drive") + " x --format las",
        "convert " + path("drive") + " x.rawlog --gzip 10",
        "convert " + path("drive") + " x --first -1"}) {
    EXPECT_EQ(run_program(arguments).status, 2) << arguments;
  }
}

TEST_F(RecordingCommands, AFolderThatIsThereIsNotTouched) {
  fs::create_directory(folder_ / "out");
  files::write_text(folder_ / "out/mine.txt", "mine");
  const ProgramResult result = run_program("convert " + path("drive") + " " + path("out"));
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.messages, HasSubstr("out: cannot be written: it is there already"));
  EXPECT_EQ(files::read_text(folder_ / "out/mine.txt"), "mine");
}

TEST_F(RecordingCommands, HelpShowsExamples) {
  for (const char* command : {"info", "convert"}) {
    const ProgramResult result = run_program(std::string(command) + " --help");
    EXPECT_EQ(result.status, 0);
    EXPECT_THAT(result.output, HasSubstr("Examples:"));
    EXPECT_THAT(result.output, HasSubstr("--recording-config"));
    EXPECT_THAT(result.messages, IsEmpty());
  }
}

}  // namespace
}  // namespace traverse::app
