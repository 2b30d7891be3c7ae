#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace traverse::replay
