#include "traverse/pipeline/run_health.hpp"

#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/json_document.hpp"
#include "traverse/pipeline/run_record.hpp"

#include "run_health_json.hpp"

namespace traverse::pipeline {
namespace {

using ::testing::HasSubstr;

/// A drive along x at 5 m/s, ten frames a second, whose record may be told frame by frame.
class MadeRun {
 public:
  explicit MadeRun(std::vector<std::string> columns) {
    columns.insert(columns.begin(), {"frame", "stamp_s"});
    columns.emplace_back("total_ms");
    frames_ = FrameTable(std::move(columns));
  }

  void add(double stamp_s, const Eigen::Vector3d& p, std::vector<double> record) {
    geometry::Pose3 pose;
    pose.translation = p;
    path_.push_back(geometry::Stamp::from_seconds(stamp_s), pose);
    record.insert(record.begin(), {static_cast<double>(frames_.rows().size()), stamp_s});
    record.push_back(10);
    frames_.add_row(std::move(record));
  }

  HealthEvidence evidence() const { return {.frames = frames_, .T_map_body = path_}; }
  const geometry::Trajectory& path() const { return path_; }

 private:
  FrameTable frames_;
  geometry::Trajectory path_;
};

struct LidarFrame {
  bool registered = true;
  double degenerate = 0;
  double ahead_m = 0;  ///< beside the even motion
  double late_s = 0;
};

/// Frame 0 is registered in nothing, as odometry's is.
MadeRun lidar_run(std::size_t frames, const std::function<LidarFrame(std::size_t)>& frame) {
  MadeRun run({"registered", "degenerate_directions"});
  for (std::size_t i = 0; i < frames; ++i) {
    const LidarFrame f = frame(i);
    const auto k = static_cast<double>(i);
    run.add(0.1 * k + f.late_s, {0.5 * k + f.ahead_m, 0.01 * std::sin(7 * k), 0},
            {i > 0 && f.registered ? 1.0 : 0.0, f.degenerate});
  }
  return run;
}

RunHealth health_of(const MadeRun& run) { return assess(run.evidence()); }

std::vector<std::string> codes(const RunHealth& health) {
  std::vector<std::string> list;
  for (const HealthReason& reason : health.reasons) list.push_back(reason.code);
  return list;
}

TEST(RunHealth, ARunOfWhichAllIsWellIsOk) {
  const RunHealth health = health_of(lidar_run(50, [](std::size_t) { return LidarFrame{}; }));
  EXPECT_EQ(health.verdict, Health::kOk);
  EXPECT_TRUE(health.reasons.empty()) << health.summary();
  EXPECT_EQ(health.registrable, 49U);
  EXPECT_EQ(health.registered_share(), 1);
  EXPECT_EQ(health.summary(), "");
}

/// What happened to users: no frame was registered, and all poses were the identity.
TEST(RunHealth, OfWhichLessThanHalfIsRegisteredIsLost) {
  for (const std::size_t registered : {0U, 1U, 24U}) {
    const RunHealth health =
        health_of(lidar_run(50, [&](std::size_t i) { return LidarFrame{i <= registered}; }));
    EXPECT_EQ(health.verdict, Health::kLost) << registered;
    EXPECT_THAT(health.summary(), HasSubstr(std::to_string(registered) + " of 49 frames"));
  }
}

TEST(RunHealth, AFrameThatWasNotRegisteredDegradesAndIsNamed) {
  const RunHealth health =
      health_of(lidar_run(50, [](std::size_t i) { return LidarFrame{i != 20 && i != 21}; }));
  EXPECT_EQ(health.verdict, Health::kDegraded);
  EXPECT_EQ(health.lost.frames, 2U);
  EXPECT_EQ(health.lost.count, 1U);
  EXPECT_EQ(health.lost.longest.first_frame, 20U);
  EXPECT_NEAR(health.lost.longest.seconds, 0.3, 1e-9);  // from frame 19 to frame 22
  EXPECT_THAT(health.summary(), HasSubstr("47 of 49 frames were registered"));
}

TEST(RunHealth, ThatEndsLostIsLostAndOneThatIsFoundAgainIsNot) {
  const auto from_30_to = [](std::size_t end) {
    return lidar_run(50, [=](std::size_t i) { return LidarFrame{i < 30 || i >= end}; });
  };
  EXPECT_EQ(health_of(from_30_to(50)).verdict, Health::kLost);
  EXPECT_THAT(codes(health_of(from_30_to(50))), ::testing::ElementsAre("ends_lost"));
  EXPECT_EQ(health_of(from_30_to(48)).verdict, Health::kDegraded);
}

TEST(RunHealth, TheFirstStageOfOdometryHoldsAFrameToo) {
  MadeRun run({"registered", "odometry_registered"});
  for (std::size_t i = 0; i < 30; ++i) {
    run.add(0.1 * static_cast<double>(i), {0.5 * static_cast<double>(i), 0, 0},
            {0, i > 0 ? 1. : 0.});
  }
  EXPECT_EQ(health_of(run).verdict, Health::kOk);
}

TEST(RunHealth, DegenerateForLongDegradesAndMostlyIsLost) {
  const auto until = [](std::size_t end) {
    return health_of(lidar_run(60, [=](std::size_t i) {
      return LidarFrame{true, i >= 5 && i < end ? 1.0 : 0.0};
    }));
  };
  EXPECT_EQ(until(8).verdict, Health::kOk);  // half a second: the prediction holds
  EXPECT_EQ(until(25).verdict, Health::kDegraded);
  EXPECT_THAT(until(25).summary(), HasSubstr("from frame 5 on"));
  EXPECT_EQ(until(50).verdict, Health::kLost);
}

TEST(RunHealth, APathThatLeapsIsLostAndOneWhoseStampsJitterIsNot) {
  const auto leap_of = [](double metres) {
    return health_of(lidar_run(60, [=](std::size_t i) {
      return LidarFrame{true, 0, i >= 30 ? metres : 0};
    }));
  };
  EXPECT_EQ(leap_of(0.5).verdict, Health::kOk);
  const RunHealth health = leap_of(5);
  EXPECT_EQ(health.verdict, Health::kLost);
  EXPECT_EQ(health.leaps.count, 1U);
  EXPECT_EQ(health.leaps.frame, 30U);
  EXPECT_NEAR(health.leaps.largest_m, 5, 0.1);
  const RunHealth jitter = health_of(lidar_run(60, [](std::size_t i) {
    return LidarFrame{true, 0, 0, 0.02 * std::sin(5.0 * static_cast<double>(i))};
  }));
  EXPECT_EQ(jitter.leaps.count, 0U);
}

TEST(RunHealth, APathWhoseStepsDoNotFitEachOtherForASecondIsDegraded) {
  const auto off_by = [](double metres, std::size_t from, std::size_t to) {
    return health_of(lidar_run(60, [=](std::size_t i) {
      const double side = i % 3 == 0 ? 1.2 : (i % 3 == 1 ? -0.2 : -1.0);
      return LidarFrame{true, 0, i >= from && i < to ? metres * side : 0};
    }));
  };
  EXPECT_EQ(off_by(0.05, 0, 60).verdict, Health::kOk);
  EXPECT_EQ(off_by(0.15, 30, 34).verdict, Health::kOk);  // not for a second
  const RunHealth health = off_by(0.15, 20, 45);
  EXPECT_EQ(health.verdict, Health::kDegraded);
  EXPECT_THAT(codes(health), ::testing::ElementsAre("shaking"));
  EXPECT_THAT(health.summary(), HasSubstr("For a second from frame "));
}

TEST(RunHealth, PosesThatNothingMovesAlthoughRegisteredAreTold) {
  MadeRun run({"registered", "degenerate_directions"});
  for (std::size_t i = 0; i < 24; ++i) {
    run.add(0.1 * static_cast<double>(i), {0, 0, 0}, {i > 0 ? 1.0 : 0.0, 0});
  }
  EXPECT_EQ(health_of(run).verdict, Health::kDegraded);
  EXPECT_THAT(codes(health_of(run)), ::testing::ElementsAre("frozen"));
}

TEST(RunHealth, ALongGapDegradesAndAShortOneIsCounted) {
  const auto with_gap = [](double seconds) {
    return health_of(lidar_run(40, [=](std::size_t i) {
      return LidarFrame{true, 0, i >= 20 ? 5 * seconds : 0, i >= 20 ? seconds : 0};
    }));
  };
  EXPECT_EQ(with_gap(0.3).verdict, Health::kOk);
  EXPECT_EQ(with_gap(0.3).gaps.count, 1U);
  EXPECT_EQ(with_gap(0.3).gaps.after_frame, 19U);
  EXPECT_EQ(with_gap(3).verdict, Health::kDegraded);
  EXPECT_THAT(with_gap(3).summary(), HasSubstr("3.1 s after frame 19"));
}

TEST(RunHealth, RecordsThatCouldNotBeUsedCountBeyondATenth) {
  const MadeRun run = lidar_run(40, [](std::size_t) { return LidarFrame{}; });
  const auto skipped = [&](std::size_t count) {
    HealthEvidence evidence = run.evidence();
    evidence.skipped_records = count;
    evidence.read_records = 40;
    return assess(evidence).verdict;
  };
  EXPECT_EQ(skipped(1), Health::kOk);
  EXPECT_EQ(skipped(8), Health::kDegraded);
  EXPECT_EQ(skipped(60), Health::kLost);
}

TEST(RunHealth, AStartThatComesLateOrCoversLittleDegrades) {
  const MadeRun run = lidar_run(400, [](std::size_t) { return LidarFrame{}; });  // 40 s
  const auto after = [&](double seconds, double rest_s) {
    HealthEvidence evidence = run.evidence();
    evidence.recording_first = geometry::Stamp::from_seconds(-seconds);
    evidence.recording_last = geometry::Stamp::from_seconds(39.9 + rest_s);
    return assess(evidence);
  };
  EXPECT_EQ(after(20, 0).verdict, Health::kOk);
  EXPECT_NEAR(*after(20, 0).first_pose_after_s, 20, 1e-9);
  EXPECT_NEAR(*after(20, 0).first_pose_share, 20 / 59.9, 1e-9);
  EXPECT_THAT(codes(after(35, 0)), ::testing::ElementsAre("late_start"));
  EXPECT_THAT(codes(after(0, 100)), ::testing::ElementsAre("covered"));
  EXPECT_EQ(after(0, 100).verdict, Health::kDegraded);
  EXPECT_EQ(after(0, 1000).verdict, Health::kLost);
}

// ---- GNSS, IMU and wheels

enum class Fix { kNone, kTaken, kRejected };
struct NavigationFrame {
  Fix gnss = Fix::kTaken;
  Fix wheels = Fix::kTaken;
  bool in_outage = false;
  bool restarted = false;
  double ahead_m = 0;
};

MadeRun navigation_run(std::size_t frames,
                       const std::function<NavigationFrame(std::size_t)>& frame) {
  MadeRun run({"in_outage", "restarted", "gnss_chi2", "gnss_rows", "gnss_rejected", "wheels_chi2",
               "wheels_rows", "wheels_rejected"});
  const auto rows = [](Fix fix, double count) { return fix == Fix::kNone ? 0 : count; };
  const auto rejected = [](Fix fix) { return fix == Fix::kRejected ? 1.0 : 0.0; };
  for (std::size_t i = 0; i < frames; ++i) {
    const NavigationFrame f = frame(i);
    const auto k = static_cast<double>(i);
    run.add(0.1 * k, {0.5 * k + f.ahead_m, 0, 0},
            {f.in_outage ? 1.0 : 0.0, f.restarted ? 1.0 : 0.0, 1, rows(f.gnss, 3), rejected(f.gnss),
             1, rows(f.wheels, 3), rejected(f.wheels)});
  }
  return run;
}

TEST(RunHealth, AFewRejectedFixesAreOutliersAndATenthOrTenSecondsOfThemAreNot) {
  const auto rejected = [](std::size_t count) {
    return health_of(navigation_run(200, [=](std::size_t i) {
      return NavigationFrame{i >= 50 && i < 50 + count ? Fix::kRejected : Fix::kTaken};
    }));
  };
  EXPECT_EQ(rejected(1).verdict, Health::kOk);
  EXPECT_EQ(rejected(1).sensors.front().rejected, 1U);
  EXPECT_EQ(rejected(15).verdict, Health::kOk);  // less than a tenth, and not for long
  EXPECT_EQ(rejected(25).verdict, Health::kDegraded);
  EXPECT_NEAR(rejected(25).sensors.front().longest_rejected_s, 2.4, 1e-9);
  const RunHealth long_spell = health_of(navigation_run(2000, [](std::size_t i) {
    return NavigationFrame{i >= 50 && i < 160 ? Fix::kRejected : Fix::kTaken};
  }));
  EXPECT_EQ(long_spell.verdict, Health::kDegraded);  // few of them, but all that came in 11 s
  EXPECT_EQ(rejected(120).verdict, Health::kLost);
  EXPECT_THAT(rejected(120).summary(), HasSubstr("120 of 200 readings"));
}

TEST(RunHealth, WheelsThatAreMostlyRejectedDegradeAndFixesStillHold) {
  const RunHealth health = health_of(navigation_run(100, [](std::size_t i) {
    return NavigationFrame{Fix::kTaken, i % 3 == 0 ? Fix::kTaken : Fix::kRejected};
  }));
  EXPECT_EQ(health.verdict, Health::kDegraded);
  EXPECT_THAT(health.summary(), HasSubstr("wheels"));
}

TEST(RunHealth, ARestartDegradesAndItsStepIsNoLeap) {
  const RunHealth health = health_of(navigation_run(100, [](std::size_t i) {
    return NavigationFrame{Fix::kTaken, Fix::kTaken, false, i == 40, i >= 40 ? 518.0 : 0};
  }));
  EXPECT_EQ(health.verdict, Health::kDegraded);
  EXPECT_EQ(health.restarts, 1U);
  EXPECT_EQ(health.leaps.count, 0U);
  EXPECT_THAT(health.summary(), HasSubstr("began again once"));
}

TEST(RunHealth, AnOutageThatWasAskedForIsNoFaultAndTheStepAfterItNone) {
  const RunHealth health = health_of(navigation_run(400, [](std::size_t i) {
    const bool is_out = i >= 100 && i < 300;
    return NavigationFrame{is_out ? Fix::kNone : Fix::kTaken, Fix::kNone, is_out, false,
                           i >= 300 ? 8.0 : 0};
  }));
  EXPECT_EQ(health.verdict, Health::kOk) << health.summary();
}

TEST(RunHealth, DeadReckoningByTheImuAloneForLongDegrades) {
  const auto without = [](std::size_t frames) {
    return health_of(navigation_run(600, [=](std::size_t i) {
      const Fix fix = i >= 100 && i < 100 + frames ? Fix::kNone : Fix::kTaken;
      return NavigationFrame{fix, fix};
    }));
  };
  EXPECT_EQ(without(50).verdict, Health::kOk);
  EXPECT_EQ(without(150).verdict, Health::kDegraded);
}

TEST(RunHealth, ASensorThatIsTakenAndNeverUsedIsTold) {
  const MadeRun run = navigation_run(100, [](std::size_t) { return NavigationFrame{Fix::kNone}; });
  HealthEvidence evidence = run.evidence();
  SensorUse gnss{.label = "antenna", .kind = sensors::SensorKind::kGnss};
  gnss.read = 700;
  gnss.reason = "700 times fix that is no place";
  evidence.sensors = {gnss};
  EXPECT_EQ(assess(evidence).verdict, Health::kDegraded);
  EXPECT_THAT(assess(evidence).summary(), HasSubstr("None of the 700 readings of antenna"));
  evidence.sensors.front().is_taken = false;
  EXPECT_EQ(assess(evidence).verdict, Health::kOk);
}

// ---- in a map

TEST(RunHealth, APlaceThatIsNotKnownInMostFramesIsLost) {
  const auto located = [](std::size_t count) {
    MadeRun run({"registered", "degenerate_directions", "located"});
    for (std::size_t i = 0; i < 60; ++i) {
      run.add(0.1 * static_cast<double>(i), {0.5 * static_cast<double>(i), 0, 0},
              {i > 0 ? 1.0 : 0.0, 0, i < count ? 1.0 : 0.0});
    }
    return health_of(run);
  };
  EXPECT_EQ(located(60).verdict, Health::kOk);
  EXPECT_EQ(located(50).verdict, Health::kDegraded);
  EXPECT_EQ(located(20).verdict, Health::kLost);
  EXPECT_NEAR(*located(20).located_share(), 20.0 / 60, 1e-12);
}

// ---- against a reference

/// The reference drives on; the estimate does a share of that and stands for the rest.
TEST(RunHealth, AnEstimateThatIsNoPathOfTheReferenceIsLostHoweverWellItIsRegistered) {
  const auto scaled = [](double share) {
    const MadeRun run = lidar_run(60, [](std::size_t) { return LidarFrame{}; });
    geometry::Trajectory estimate;
    geometry::Trajectory reference;
    for (std::size_t i = 0; i < run.path().size(); ++i) {
      const auto k = static_cast<double>(i);
      geometry::Pose3 pose;
      pose.translation = {0.5 * k, 3 * std::sin(k / 10), 0.3 * std::cos(k / 7)};
      reference.push_back(run.path().stamp(i), pose);
      pose.translation *= share;
      estimate.push_back(run.path().stamp(i), pose);
    }
    const auto evaluation =
        evaluation::evaluate(estimate, reference, evaluation::run_evaluation_options());
    HealthEvidence evidence = run.evidence();
    evidence.reference = &reference;
    evidence.evaluation = &evaluation;
    return assess(evidence);
  };
  EXPECT_EQ(scaled(1.01).verdict, Health::kOk);
  EXPECT_NEAR(*scaled(1.01).error_share, 0.01, 1e-3);
  EXPECT_EQ(scaled(1.05).verdict, Health::kOk);
  EXPECT_EQ(scaled(1.2).verdict, Health::kDegraded);
  EXPECT_EQ(scaled(0.8).verdict, Health::kDegraded);
  EXPECT_EQ(scaled(0.1).verdict, Health::kLost);
  EXPECT_EQ(scaled(0.49).verdict, Health::kLost);
}

// ---- what others found

TEST(RunHealth, TakesWhatWasFoundAndPutsTheWorstFirst) {
  const MadeRun run = lidar_run(40, [](std::size_t i) { return LidarFrame{i != 20}; });
  HealthEvidence evidence = run.evidence();
  evidence.troubles = {{Health::kDegraded, "pose_graph", "The pose graph could not be solved."}};
  evidence.contradictions = {
      {"gyro_in_degrees", Health::kLost, "The gyro turns 57 times as far.", "imu.unit=deg"},
      {"odd", Health::kOk, "Nothing to worry about.", ""}};
  const RunHealth health = assess(evidence);
  EXPECT_EQ(health.verdict, Health::kLost);
  EXPECT_THAT(codes(health),
              ::testing::ElementsAre("gyro_in_degrees", "not_registered", "pose_graph"));
  EXPECT_EQ(health.summary(), "The gyro turns 57 times as far.");
  EXPECT_EQ(health.contradictions.size(), 2U);
}

TEST(RunHealth, OfScansThatAreNotDeskewedTheDataSpeakBeforeTheFormat) {
  const MadeRun run = lidar_run(40, [](std::size_t) { return LidarFrame{}; });
  HealthEvidence evidence = run.evidence();
  evidence.troubles = {{Health::kDegraded, "not_deskewed", "Times are unknown."}};
  EXPECT_THAT(codes(assess(evidence)), ::testing::ElementsAre("not_deskewed"));
  evidence.contradictions = {{"point_times_unknown", Health::kDegraded, "The scans are raw.", ""}};
  EXPECT_THAT(codes(assess(evidence)), ::testing::ElementsAre("point_times_unknown"));
}

TEST(RunHealth, IsReadBackAsItWasWritten) {
  const MadeRun run = navigation_run(100, [](std::size_t i) {
    return NavigationFrame{i > 20 && i < 50 ? Fix::kRejected : Fix::kTaken, Fix::kTaken, false,
                           i == 70};
  });
  HealthEvidence evidence = run.evidence();
  evidence.skipped_records = 3;
  evidence.read_records = 100;
  evidence.recording_first = geometry::Stamp::from_seconds(-1);
  evidence.recording_last = geometry::Stamp::from_seconds(12);
  evidence.contradictions = {{"code", Health::kDegraded, "Text.", "a.b=c"}};
  const std::string text = to_json(assess(evidence)).dump();
  const auto document = files::JsonDocument::parse(text);
  EXPECT_EQ(to_json(health_from_json(document.root())).dump(), text);
}

TEST(RunHealth, OfARunWithoutAFrameIsNothingToSay) {
  const MadeRun run({"registered"});
  EXPECT_EQ(assess(run.evidence()).frames, 0U);
}

}  // namespace
}  // namespace traverse::pipeline
