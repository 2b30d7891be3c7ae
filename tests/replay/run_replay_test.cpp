#include <algorithm>
#include <filesystem>
#include <variant>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/pipeline/run.hpp"
#include "traverse/replay/recording.hpp"
#include "traverse/replay/session.hpp"

#include "replay/simulated_rawlog.hpp"
#include "temporary_folder.hpp"

namespace traverse::replay {
namespace {

constexpr std::size_t kFramesOfRun = 14;

/// A run of the default preset on a part of a street, and its folder.
class RunReplay : public ::testing::Test {
 protected:
  RunReplay() {
    testing::write_simulated_rawlog(file_, kFramesOfRun);
    pipeline::PresetRequest request;
    request.assignments = {"start.slowest_mps=8", "start.fastest_mps=12"};
    const Recording recording = Recording::open(file_, testing::open_options());
    pipeline::Pipeline pipeline = recording.make_pipeline(request, 1);
    pipeline::RunOptions options;
    options.first = 3;
    options.last = 11;
    options.hash_recording = false;
    const auto source = recording.source();
    const pipeline::RunRecord record = pipeline::run(*source, pipeline, folder_, options, {});
    EXPECT_EQ(record.status, pipeline::RunStatus::kOk) << record.reason;
  }
  Recording open(const std::filesystem::path& moved_to = {}) const {
    return Recording::open(folder_.path, testing::open_options(), moved_to);
  }

  testing::TemporaryFolder parent_;
  std::filesystem::path file_ = parent_ / "street.rawlog";
  pipeline::RunFolder folder_{parent_ / "run"};
};

TEST_F(RunReplay, ShowsTheFramesOfTheRun) {
  const Recording run = open();
  EXPECT_TRUE(run.is_run());
  EXPECT_EQ(run.first_frame(), 3U);
  EXPECT_EQ(run.max_frames(), 12U);

  const pipeline::Pipeline pipeline = run.make_pipeline({}, 1);
  EXPECT_EQ(pipeline.name, "traverse (as run)");
  Session session(run.source(), pipeline.estimator->clone(), run.frame_sensor(), 3);
  const auto go_on = [](const SessionFrame&) { return true; };
  ASSERT_EQ(session.go_to(11, go_on), Session::Outcome::kThere);
  const SessionFrame& frame = *session.frame();
  EXPECT_EQ(frame.pose.stamp, geometry::Stamp::from_seconds(1.1));
  EXPECT_NEAR(frame.pose.T_map_body.translation.norm(), 8, 0.2);  // 10 m/s from frame 3 on
  ASSERT_TRUE(frame.scan);
  const auto& columns = session.estimator().columns();
  ASSERT_EQ(columns.size(), frame.pose.record.size());
  const auto column = std::find(columns.begin(), columns.end(), "registered");
  ASSERT_NE(column, columns.end());
  EXPECT_EQ(frame.pose.record[static_cast<std::size_t>(column - columns.begin())], 1);
  EXPECT_EQ(session.go_to(12, go_on), Session::Outcome::kEnd);
}

TEST_F(RunReplay, FindsARecordingThatWasMoved) {
  const std::filesystem::path elsewhere = parent_ / "elsewhere/street.rawlog";
  std::filesystem::create_directory(elsewhere.parent_path());
  for (const char* name : {"street.rawlog", "street.traverse.yaml", "street.reference.tum"}) {
    std::filesystem::rename(parent_ / name, parent_ / "elsewhere" / name);
  }
  try {
    open();
    FAIL() << "the recording is not there";
  } catch (const files::InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("--moved-to"));
  }
  EXPECT_EQ(open(elsewhere).info().path, elsewhere);
}

TEST_F(RunReplay, FindsARecordingThatMovedAlong) {
  const std::string name = "it's where it is, in a folder of a name that messages would shorten";
  std::filesystem::create_directory(parent_ / name);
  for (const char* moved :
       {"street.rawlog", "street.traverse.yaml", "street.reference.tum", "run"}) {
    std::filesystem::rename(parent_ / moved, parent_ / name / moved);
  }
  const Recording run = Recording::open(parent_ / name / "run", testing::open_options());
  EXPECT_EQ(run.info().path, parent_ / name / "street.rawlog");
  ASSERT_TRUE(run.reference());
  EXPECT_EQ(run.reference()->T_map_body.size(), kFramesOfRun);
  EXPECT_EQ(run.make_pipeline({}, 1).name, "traverse (as run)");
}

/// A run that was made in a folder from relative paths, its statements in a file there, its preset
/// the user's own, its reference named on the command line.
TEST_F(RunReplay, HoldsFromAnyFolder) {
  const std::filesystem::path here = std::filesystem::current_path();
  std::filesystem::current_path(parent_.path());
  files::write_text("stated.yaml", "name: stated\nreference: {file: truth.tum, format: tum}\n");
  std::filesystem::rename("street.reference.tum", "truth.tum");
  std::filesystem::copy_file(TRAVERSE_SHARE_DIR "/pipelines/floam.yaml", "own.yaml");
  dataset::OpenOptions options = testing::open_options();
  options.statements_file = "stated.yaml";
  options.statements = {"lidar.max_range_m=70"};
  const Recording recording = Recording::open("street.rawlog", options);
  pipeline::PresetRequest request;
  request.name = "own.yaml";
  request.assignments = {"solver.huber_m=0.07"};
  pipeline::Pipeline pipeline = recording.make_pipeline(request, 1);
  pipeline::RunOptions run_options;
  run_options.hash_recording = false;
  run_options.statements = dataset::lasting_statements("street.rawlog", options);
  const auto source = recording.source();
  const auto record = pipeline::run(*source, pipeline, {"second"}, run_options, {});
  ASSERT_EQ(record.status, pipeline::RunStatus::kOk) << record.reason;
  std::filesystem::remove("own.yaml");
  std::filesystem::remove("stated.yaml");
  std::filesystem::remove("truth.tum");
  std::filesystem::current_path("/");

  const Recording run =
      Recording::open((parent_ / "second").lexically_relative("/"), testing::open_options());
  EXPECT_EQ(run.info().path, parent_ / "street.rawlog");
  EXPECT_EQ(run.info().name, "stated");
  EXPECT_EQ(run.info().rig.first(sensors::SensorKind::kLidar)->lidar->max_range_m, 70);
  ASSERT_TRUE(run.reference()) << "the run has it";
  const pipeline::Pipeline replayed = run.make_pipeline({}, 1);
  EXPECT_EQ(replayed.name, "own (as run)");
  const auto huber =
      std::find_if(replayed.settings.begin(), replayed.settings.end(),
                   [](const auto& resolved) { return resolved.setting.path == "solver.huber_m"; });
  ASSERT_NE(huber, replayed.settings.end());
  EXPECT_EQ(std::get<double>(huber->setting.value), 0.07);
  std::filesystem::current_path(here);
}

}  // namespace
}  // namespace traverse::replay
