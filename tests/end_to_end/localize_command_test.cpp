#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/files/text_file.hpp"

#include "end_to_end/program.hpp"
#include "temporary_folder.hpp"

namespace traverse {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ProgramResult;
using testing::run_program;

geometry::Trajectory tum(const std::string& file) {
  return dataset::read_trajectory(file, dataset::TrajectoryFormat::kTum);
}

/// The map of a stretch of street, and other drives, made once.
class LocalizeCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new testing::TemporaryFolder;
    simulate("mapped", "--first 40 --duration 4");
    simulate("other_day", "--first 40 --duration 8 --drive-seed 5");
    const ProgramResult map = run_program("run " + path("mapped.rawlog") + " -o " + path("map") +
                                          " --set slam.gnss.use=false --no-report --no-hash");
    ASSERT_EQ(map.status, 0) << map.messages;
  }
  static void TearDownTestSuite() { delete folder_; }

  static void simulate(const std::string& name, const std::string& options) {
    const ProgramResult made = run_program("simulate town_short --sensor vlp16 " + options +
                                           " -o " + path(name + ".rawlog"));
    ASSERT_EQ(made.status, 0) << made.messages;
  }
  static ProgramResult localize(const std::string& recording, const std::string& options) {
    return run_program("localize " + path(recording + ".rawlog") + " --map " + path("map") +
                       " -o " + path("placed") + " --no-report --no-hash " + options);
  }
  static std::string path(const std::string& name) { return (*folder_ / name).string(); }

  /// What the run says of where the place was found and lost.
  static std::string place() {
    const auto record = nlohmann::json::parse(files::read_text(path("placed/run.json")));
    for (const auto& decision : record["decisions"]) {
      if (decision["name"] == "place") return decision["value"];
    }
    return "nothing";
  }

 private:
  static inline testing::TemporaryFolder* folder_ = nullptr;
};

TEST_F(LocalizeCommand, ADriveOfAnotherDayIsFoundAndItsPosesAreInTheMap) {
  const ProgramResult result = localize("other_day", "--first 8 --last 27");
  ASSERT_EQ(result.status, 0) << result.messages;
  EXPECT_THAT(place(), AllOf(HasSubstr("found in frame"), Not(HasSubstr("lost"))));
  const auto placed = tum(path("placed/trajectory.tum"));
  const auto truth = tum(path("other_day.reference.tum"));
  const geometry::Pose3 T_world_map =
      tum(path("mapped.reference.tum")).at(tum(path("map/trajectory.tum")).stamp(0), 0.1).value();
  ASSERT_EQ(placed.size(), 20U);
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const geometry::Pose3 T_map_body =
        T_world_map.inverse() * truth.at(placed.stamp(i), 0.1).value();
    EXPECT_LT((placed.pose(i).translation - T_map_body.translation).norm(), 0.1) << i;
  }
}

TEST_F(LocalizeCommand, LeavingTheMapIsSaidWithItsReason) {
  const ProgramResult result = localize("other_day", "--first 20 --last 65");
  ASSERT_EQ(result.status, 0) << result.messages;
  EXPECT_THAT(place(), AllOf(HasSubstr("found in frame"), HasSubstr("lost in frame")));
}

TEST_F(LocalizeCommand, AnotherPlaceIsNotFoundAndTheErrorSaysWhatWasTried) {
  simulate("elsewhere", "--first 40 --duration 0.6 --seed 9");
  const ProgramResult result = localize("elsewhere", "--last 5");
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.messages, AllOf(HasSubstr("none of 6 scans was found"),
                                     HasSubstr("little in common"), HasSubstr("another place")));
}

}  // namespace
}  // namespace traverse
