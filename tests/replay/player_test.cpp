#include "traverse/replay/player.hpp"

#include <chrono>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/dataset/trajectory_files.hpp"

#include "replay/simulated_rawlog.hpp"
#include "temporary_folder.hpp"

namespace traverse::replay {
namespace {

constexpr std::size_t kFramesPlayed = 16;

class PlayerTest : public ::testing::Test {
 protected:
  PlayerTest() {
    testing::write_simulated_rawlog(folder_ / "street.rawlog", kFramesPlayed);
    PlayerOptions options;
    options.preset.assignments = {"start.slowest_mps=8", "start.fastest_mps=12",
                                  "start.step_mps=4"};
    options.keep_index = false;
    player_ = std::make_unique<Player>(
        Recording::open(folder_ / "street.rawlog", testing::open_options()), options);
  }

  /// Waits for something that another thread does; a minute is far more than it takes.
  template <typename Condition>
  ::testing::AssertionResult eventually(const Condition& condition) const {
    for (int i = 0; i < 6000; ++i) {
      if (condition(player_->status())) return ::testing::AssertionSuccess();
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return ::testing::AssertionFailure() << "error: " << player_->status().error;
  }
  ::testing::AssertionResult shows(std::size_t frame) const {
    return eventually([=](const PlayerStatus& s) { return s.settled && s.shown == frame; });
  }

  testing::TemporaryFolder folder_;
  std::unique_ptr<Player> player_;
};

TEST_F(PlayerTest, ShowsTheFirstFrameAndIndexesTheRest) {
  EXPECT_TRUE(shows(0));
  EXPECT_TRUE(eventually([](const PlayerStatus& s) { return s.frames_complete; }));
  EXPECT_EQ(player_->status().frames, kFramesPlayed);
  EXPECT_GT(player_->shown()->scan.points_body.size(), 1000U);
  EXPECT_EQ(player_->shown()->scan.feature_class.size(), player_->shown()->scan.points_body.size());
  EXPECT_EQ(player_->shown()->scan.ring.size(), player_->shown()->scan.points_body.size());
}

TEST_F(PlayerTest, PlaysToTheEndOnceAndKeepsEveryFrame) {
  ASSERT_TRUE(eventually([](const PlayerStatus& s) { return s.frames_complete; }));
  player_->control([](Controls& c) {
    c.set_unlimited(true);
    c.play();
  });
  EXPECT_TRUE(shows(kFramesPlayed - 1));
  const auto past = player_->past(0);
  ASSERT_EQ(past.size(), kFramesPlayed);
  for (std::size_t i = 0; i < kFramesPlayed; ++i) EXPECT_EQ(past[i].number, i);
  ASSERT_TRUE(past.back().error_m);
  EXPECT_LT(*past.back().error_m, 0.3);
  EXPECT_EQ(player_->reference_in_map().size(), kFramesPlayed);
  EXPECT_GT(player_->choose_map({0, 0, 0}, 5000)->points.size(), 3000U);
}

TEST_F(PlayerTest, SeeksBackAndForthWithoutForgettingOrRepeating) {
  ASSERT_TRUE(eventually([](const PlayerStatus& s) { return s.frames_complete; }));
  for (const char* place : {"12", "3", "0.9s", "4"}) ASSERT_TRUE(player_->seek(place));
  EXPECT_TRUE(shows(4));
  ASSERT_TRUE(player_->seek("11"));
  EXPECT_TRUE(shows(11));
  ASSERT_TRUE(player_->seek("5"));
  EXPECT_TRUE(shows(5));
  const auto past = player_->past(0);
  EXPECT_GE(past.size(), 12U);
  for (std::size_t i = 0; i < past.size(); ++i) EXPECT_EQ(past[i].number, i);
  EXPECT_EQ(player_->shown()->pose.T_map_body.matrix(), past[5].pose.T_map_body.matrix());
  EXPECT_FALSE(player_->seek("soon"));
}

TEST_F(PlayerTest, RestartsHereWithOtherSettings) {
  ASSERT_TRUE(eventually([](const PlayerStatus& s) { return s.frames_complete; }));
  player_->seek("6");
  ASSERT_TRUE(shows(6));
  pipeline::PresetRequest request;
  request.assignments = {"map.radius_m=40"};
  player_->restart(request, 6);
  EXPECT_TRUE(eventually([](const PlayerStatus& s) { return s.generation == 2 && s.settled; }));
  EXPECT_EQ(player_->past(0).front().number, 6U);
  const auto settings = player_->settings();
  const auto radius = std::find_if(settings.begin(), settings.end(), [](const auto& entry) {
    return entry.setting.path == "map.radius_m";
  });
  ASSERT_NE(radius, settings.end());
  EXPECT_EQ(std::get<double>(radius->setting.value), 40);

  request.assignments = {"map.radius_m=wide"};
  player_->restart(request, 6);
  EXPECT_TRUE(eventually(
      [](const PlayerStatus& s) { return s.message.find("map.radius_m") != std::string::npos; }));
  EXPECT_EQ(player_->status().error, "");  // the estimator there was goes on
}

TEST_F(PlayerTest, SavesWhatIsKnownUpToTheFrameOnShow) {
  ASSERT_TRUE(eventually([](const PlayerStatus& s) { return s.frames_complete; }));
  player_->seek("9");
  ASSERT_TRUE(shows(9));
  player_->seek("4");
  ASSERT_TRUE(shows(4));
  player_->save(folder_ / "saved");
  EXPECT_TRUE(eventually([](const PlayerStatus& s) { return s.message.starts_with("saved"); }));
  const auto saved =
      dataset::read_trajectory(folder_ / "saved/trajectory.tum", dataset::TrajectoryFormat::kTum);
  EXPECT_EQ(saved.size(), 5U);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "saved/map.ply"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "saved/reference.tum"));
}

}  // namespace
}  // namespace traverse::replay
