#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/dataset/trajectory_files.hpp"

#include "dataset/bag_of_recording.hpp"
#include "dataset/made_recordings.hpp"
#include "end_to_end/program.hpp"
#include "temporary_folder.hpp"
#include "test_data.hpp"

namespace traverse {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::run_program;
using testing::TemporaryFolder;

geometry::Trajectory run(const fs::path& recording, const fs::path& folder) {
  const auto result = run_program("run " + recording.string() + " -o " + folder.string() +
                                  " --no-report --no-hash");
  EXPECT_EQ(result.status, 0) << result.everything();
  if (result.status != 0) return {};
  return dataset::read_trajectory(folder / "trajectory.tum", dataset::TrajectoryFormat::kTum);
}

TEST(Bags, ATownDriveGivesTheTrajectoryOfItsRawlogWhateverBagItIsToldIn) {
  const TemporaryFolder folder;
  const auto made = run_program("simulate town_short --first 60 --duration 3 -o " +
                                (folder / "town.rawlog").string());
  ASSERT_EQ(made.status, 0) << made.messages;
  const auto expected = run(folder / "town.rawlog", folder / "run_rawlog");
  ASSERT_GT(expected.size(), 20U);
  EXPECT_GT(expected.path_length(), 5);
  const auto rawlog = testing::open(folder / "town.rawlog");
  for (const testing::BagKind& kind : testing::bag_kinds()) {
    SCOPED_TRACE(kind.name);
#ifdef TRAVERSE_SANITIZED
    if (kind.name != testing::bag_kinds().front().name)
      continue;  // the others in the library's own
#endif
    const fs::path bag = testing::write_bag(kind, folder.path(), *rawlog);
    const auto found = run(bag, folder / ("run_" + kind.name));
    ASSERT_EQ(found.size(), expected.size());
    double largest = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found.stamp(i), expected.stamp(i));
      largest =
          std::max(largest, (found.pose(i).translation - expected.pose(i).translation).norm());
    }
    EXPECT_LT(largest, 1e-3);
    fs::remove_all(bag);
  }
}

TEST(Bags, InfoListsTopicsAndAnUnknownOneIsNoError) {
  const TemporaryFolder folder;
  std::vector<testing::MadeMessage> messages;
  for (int i = 0; i < 3; ++i) {
    const std::int64_t ns = 1'700'000'000'000'000'000 + i * 10'000'000;
    messages.push_back(
        {"/imu", "sensor_msgs/Imu", ns,
         testing::imu_message(testing::Wire::kRos1, ns, "imu", {0, 0, 0}, {0, 0, 9.81})});
    messages.push_back({"/thing", "my_msgs/Thing", ns, "abc"});
  }
  testing::write_ros1_bag(folder / "a.bag", messages);
  const auto info = run_program("info " + (folder / "a.bag").string());
  EXPECT_EQ(info.status, 0) << info.messages;
  EXPECT_THAT(info.output, HasSubstr("/imu    sensor_msgs/Imu"));
  EXPECT_THAT(info.output, HasSubstr("my_msgs/Thing"));
  EXPECT_THAT(info.output, HasSubstr("no type that is used"));
}

TEST(Bags, RecordingsOfPacketsAreListedByInfoAndRun) {
  const fs::path bag = testing::test_data() / "recordings/ros2_packets/xt32/1673400677802009732";
  if (!fs::exists(bag)) GTEST_SKIP() << "no recordings beside the repository";
  const auto info = run_program("info " + bag.string());
  EXPECT_EQ(info.status, 0) << info.messages;
  EXPECT_THAT(info.output, HasSubstr("pandar_msgs/PandarScan"));
  const TemporaryFolder folder;
  const auto run = run_program("run " + bag.string() + " -o " + (folder / "r").string() +
                               " --no-report --no-hash");
  EXPECT_EQ(run.status, 0) << run.messages;
}

}  // namespace
}  // namespace traverse
