#include "traverse/replay/session.hpp"

#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "traverse/replay/recording.hpp"

#include "replay/simulated_rawlog.hpp"
#include "temporary_folder.hpp"

namespace traverse::replay {
namespace {

constexpr std::size_t kFramesOfSession = 24;

/// All that can be seen of an estimator at a frame, but for wall times.
struct Seen {
  std::size_t number = 0;
  geometry::Stamp stamp;
  Eigen::Matrix4d T_map_body;
  geometry::Twist velocity;
  std::vector<double> record;
  std::vector<Eigen::Vector3d> local_map;
  std::vector<Eigen::Vector3d> matched;
  geometry::Stamp scan;
};

Seen look_at(const Session& session) {
  Seen seen;
  const SessionFrame& frame = *session.frame();
  seen.number = frame.number;
  seen.stamp = frame.pose.stamp;
  seen.T_map_body = frame.pose.T_map_body.matrix();
  seen.velocity = frame.pose.velocity;
  const auto& columns = session.estimator().columns();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (!columns[i].ends_with("_ms")) seen.record.push_back(frame.pose.record[i]);
  }
  seen.local_map = session.estimator().local_map();
  for (const auto& match : session.estimator().matches()) {
    seen.matched.push_back(match.p_map);
    seen.matched.push_back(match.foot_map);
  }
  if (frame.scan) seen.scan = sensors::stamp_of(*frame.scan);
  return seen;
}

/// Bit for bit: == on doubles, no tolerance.
void expect_same(const Seen& a, const Seen& b) {
  EXPECT_EQ(a.number, b.number);
  EXPECT_EQ(a.stamp, b.stamp);
  EXPECT_EQ(a.scan, b.scan);
  EXPECT_TRUE(a.T_map_body == b.T_map_body) << a.number;
  EXPECT_TRUE(a.velocity == b.velocity) << a.number;
  EXPECT_EQ(a.record, b.record) << a.number;
  EXPECT_TRUE(a.local_map == b.local_map) << a.number;
  EXPECT_TRUE(a.matched == b.matched) << a.number;
}

bool go_on(const SessionFrame&) { return true; }

struct Case {
  const char* preset;
  int gzip_level;
};

class SessionTest : public ::testing::TestWithParam<Case> {
 protected:
  SessionTest() {
    testing::write_simulated_rawlog(folder_ / "street.rawlog", kFramesOfSession,
                                    GetParam().gzip_level);
    recording_ = Recording::open(folder_ / "street.rawlog", testing::open_options());
  }

  std::unique_ptr<pipeline::Estimator> estimator() const {
    pipeline::PresetRequest request;
    request.name = GetParam().preset;
    request.assignments = {"start.slowest_mps=8", "start.fastest_mps=12", "start.step_mps=4"};
    return recording_->make_pipeline(request, 1).estimator;
  }
  Session session(std::size_t origin = 0) const {
    return {recording_->source(), estimator(), recording_->frame_sensor(), origin};
  }

  testing::TemporaryFolder folder_;
  std::optional<Recording> recording_;
};

class SessionOfAnyPreset : public SessionTest {};

TEST_P(SessionOfAnyPreset, AFrameIsTheSameHoweverOneArrivedThere) {
  std::vector<Seen> played;
  Session straight = session();
  for (std::size_t i = 0; i < kFramesOfSession; ++i) {
    ASSERT_EQ(straight.go_to(i, go_on), Session::Outcome::kThere);
    played.push_back(look_at(straight));
  }
  EXPECT_GT(played.back().local_map.size(), 500U);
  EXPECT_GT(played.back().matched.size(), 100U);

  Session jumping = session();
  std::mt19937 random(7);
  std::uniform_int_distribution<std::size_t> any(0, kFramesOfSession - 1);
  for (int jump = 0; jump < 8; ++jump) {
    const std::size_t frame = any(random);
    ASSERT_EQ(jumping.go_to(frame, go_on), Session::Outcome::kThere);
    expect_same(look_at(jumping), played[frame]);
  }
  for (std::size_t frame : {19U, 18U, 17U, 16U, 0U, 1U, 23U}) {  // steps back, first, last
    ASSERT_EQ(jumping.go_to(frame, go_on), Session::Outcome::kThere);
    expect_same(look_at(jumping), played[frame]);
  }
}

TEST_P(SessionOfAnyPreset, SaysHowLargeItsCheckpointsAre) {
  Session session = this->session();
  session.go_to(kFramesOfSession - 1, go_on);
  // The map is the largest part: tens of bytes for each of its thousands of points.
  EXPECT_GT(session.estimator().bytes(), 30 * session.estimator().local_map().size());
  EXPECT_GT(session.checkpoints().bytes(), session.estimator().bytes());
  EXPECT_LT(session.checkpoints().bytes(), Checkpoints::kMostBytes);
}

TEST_P(SessionOfAnyPreset, KnowsWhetherTheEstimatorIsAtTheFrame) {
  // The first four scans are held back: their frames come together.
  Session session = this->session();
  for (const auto& [frame, is_there] :
       {std::pair{0U, false}, {2U, false}, {3U, true}, {9U, true}}) {
    session.go_to(frame, go_on);
    EXPECT_EQ(session.estimator_is_at_frame(), is_there) << frame;
  }
}

TEST_P(SessionTest, StepsBackTakeFewFrames) {
  Session session = this->session();
  session.go_to(22, go_on);
  int worked = 0;
  const auto count = [&](const SessionFrame&) {
    ++worked;
    return true;
  };
  for (std::size_t frame = 21; frame >= 11; --frame) session.go_to(frame, count);
  // From the checkpoints ten frames apart alone it would be 11 steps of 5.5 frames on average.
  EXPECT_LE(worked, 35);
}

TEST_P(SessionTest, BeyondTheEndIsTheLastFrame) {
  Session session = this->session();
  EXPECT_EQ(session.go_to(1000, go_on), Session::Outcome::kEnd);
  ASSERT_TRUE(session.frame());
  EXPECT_EQ(session.frame()->number, kFramesOfSession - 1);
  EXPECT_EQ(session.go_to(3, go_on), Session::Outcome::kThere);
}

TEST_P(SessionTest, StopsWhereItIsToldTo) {
  Session session = this->session();
  const auto until_five = [](const SessionFrame& frame) { return frame.number < 5; };
  EXPECT_EQ(session.go_to(20, until_five), Session::Outcome::kStopped);
  EXPECT_EQ(session.frame()->number, 5U);
}

TEST_P(SessionTest, BeginsAtItsOrigin) {
  Session session = this->session(12);
  ASSERT_EQ(session.go_to(12, go_on), Session::Outcome::kThere);
  EXPECT_EQ(session.frame()->pose.stamp, geometry::Stamp::from_seconds(1.2));
  EXPECT_TRUE(session.frame()->pose.T_map_body.translation.isZero());
  ASSERT_EQ(session.go_to(3, go_on), Session::Outcome::kThere);
  EXPECT_EQ(session.frame()->number, 12U);

  session.restart(estimator(), 20);
  ASSERT_EQ(session.go_to(21, go_on), Session::Outcome::kThere);
  EXPECT_EQ(session.frame()->pose.stamp, geometry::Stamp::from_seconds(2.1));
}

std::string name_of(const ::testing::TestParamInfo<Case>& info) {
  return fmt::format("{}{}", info.param.preset, info.param.gzip_level == 0 ? "Plain" : "");
}

INSTANTIATE_TEST_SUITE_P(Lidar, SessionOfAnyPreset,
                         ::testing::Values(Case{"traverse", 1}, Case{"floam", 1}, Case{"aloam", 1},
                                           Case{"loam", 1}),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Files, SessionTest,
                         ::testing::Values(Case{"traverse", 0}, Case{"traverse", 1}), name_of);

}  // namespace
}  // namespace traverse::replay
