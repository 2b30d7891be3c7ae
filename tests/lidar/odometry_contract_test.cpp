// What lidar::Odometry promises, held by every kind of it. A new kind joins by one line of kKinds.

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "traverse/lidar/odometry.hpp"
#include "traverse/loam/scan_to_map_odometry.hpp"
#include "traverse/loam/two_stage_odometry.hpp"
#include "traverse/sensors/rings.hpp"
#include "traverse/voxel_map/voxel_map_odometry.hpp"

#include "lidar/odometry_trial.hpp"
#include "lidar/shown_matches.hpp"
#include "lidar/simulated_drive.hpp"
#include "loam/simulated_gyro.hpp"

namespace traverse::lidar {
namespace {

using optimization::Termination;
using testing::SimulatedDrive;
using testing::worst_position_error;

/// How an odometry is made for a case.
struct Making {
  sensors::LidarProfile profile = simulation::demo_scanner().profile;
  bool motion_compensated = false;
  bool deskew = true;
  bool from_rest = false;  ///< without a search for the initial speed
  int threads = 1;
};

struct Kind {
  std::string name;
  std::function<std::unique_ptr<Odometry>(const Making&)> make;
  bool needs_rings;
  double within_m;       ///< of the truth, after 18 m with a range noise of 2 cm
  double map_spacing_m;  ///< the next point of the map is nearer to what was matched
};

void PrintTo(const Kind& kind, std::ostream* to) { *to << kind.name; }

/// The options that all kinds have, as `how` says; few hypotheses of the initial speed, because the
/// search has tests of its own.
template <typename Made, typename Options>
std::unique_ptr<Odometry> made(Options options, const Making& how) {
  options.deskew = how.deskew;
  options.threads = how.threads;
  options.start.slowest_mps = 8;
  options.start.fastest_mps = 16;
  if (how.from_rest) options.start.scans = 0;
  return std::make_unique<Made>(options, how.profile, how.motion_compensated);
}

std::unique_ptr<Odometry> two_stage(loam::SweepMotion sweep_motion, const Making& how) {
  loam::TwoStageOdometryOptions options;
  options.solver.line_form = loam::LineForm::kVector;
  options.odometry.sweep_motion = sweep_motion;
  options.imu.use = sweep_motion == loam::SweepMotion::kDeskew;
  return made<loam::TwoStageOdometry>(options, how);
}

const Kind kKinds[] = {
    {"scan_to_map",
     [](const Making& how) {
       return made<loam::ScanToMapOdometry>(loam::ScanToMapOdometryOptions{}, how);
     },
     true, 0.1, 1},
    {"two_stage_per_point",
     [](const Making& how) { return two_stage(loam::SweepMotion::kPerPoint, how); }, true, 0.1, 1},
    {"two_stage_deskew",
     [](const Making& how) { return two_stage(loam::SweepMotion::kDeskew, how); }, true, 0.1, 1},
    {"voxel_map",
     [](const Making& how) {
       return made<voxel_map::VoxelMapOdometry>(voxel_map::VoxelMapOdometryOptions{}, how);
     },
     false, 0.06, 1.5}};

/// A scan of the first `points` points of another one.
sensors::LidarScan cut(const sensors::LidarScan& scan, std::size_t points) {
  sensors::LidarScan result = scan;
  for (auto* values : {&result.x, &result.y, &result.z, &result.intensity, &result.time}) {
    values->resize(points);
  }
  result.ring.resize(points);
  return result;
}

template <typename Matrix>
bool same_bits(const Matrix& a, const Matrix& b) {
  return std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

void expect_same_frame(const Frame& a, const Frame& b, const std::string& what) {
  EXPECT_EQ(a.index, b.index) << what;
  EXPECT_EQ(a.stamp, b.stamp) << what;
  EXPECT_TRUE(same_bits(a.T_map_lidar.rotation, b.T_map_lidar.rotation)) << what;
  EXPECT_TRUE(same_bits(a.T_map_lidar.translation, b.T_map_lidar.translation)) << what;
  EXPECT_TRUE(same_bits(a.velocity, b.velocity)) << what;
  EXPECT_EQ(a.map_points, b.map_points) << what;
  EXPECT_EQ(a.health.residual_rms_m, b.health.residual_rms_m) << what;
  EXPECT_EQ(a.health.reason, b.health.reason) << what;
  EXPECT_TRUE(same_bits(a.health.covariance(), b.health.covariance())) << what;
  EXPECT_EQ(a.further, b.further) << what;
}

void expect_same_frames(const std::vector<Frame>& a, const std::vector<Frame>& b,
                        const std::string& what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  for (std::size_t i = 0; i < a.size(); ++i) {
    expect_same_frame(a[i], b[i], what + ", frame " + std::to_string(i));
  }
}

class OdometryContract : public ::testing::TestWithParam<Kind> {
 protected:
  static void SetUpTestSuite() {
    street_ = new SimulatedDrive(simulation::street(60, 1), 16, 12);
    swerve_ = new SimulatedDrive(simulation::street(60, 1), 16, testing::swerving());
  }
  static void TearDownTestSuite() {
    delete street_;
    delete swerve_;
  }
  void SetUp() override {
#ifdef TRAVERSE_SANITIZED
    if (GetParam().name == "two_stage_per_point") GTEST_SKIP() << "as two_stage_deskew, and slow";
#endif
  }
  static const SimulatedDrive& street() { return *street_; }
  static const SimulatedDrive& swerve() { return *swerve_; }

  static std::unique_ptr<Odometry> make(const Making& how = {}) { return GetParam().make(how); }
  static std::vector<Frame> run(const SimulatedDrive& drive, const Making& how = {}) {
    return testing::frames_of(*make(how), drive);
  }
  static double within_m() { return GetParam().within_m; }

 private:
  static inline SimulatedDrive* street_ = nullptr;
  static inline SimulatedDrive* swerve_ = nullptr;
};

INSTANTIATE_TEST_SUITE_P(Kinds, OdometryContract, ::testing::ValuesIn(kKinds),
                         [](const auto& kind) { return kind.param.name; });

TEST_P(OdometryContract, FollowsADriveThatStartsAtSpeed) {
  const auto odometry = make();
  EXPECT_FALSE(odometry->factors().empty());
  const auto frames = testing::frames_of(*odometry, street());
  ASSERT_EQ(frames.size(), street().scans.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].index, i);
    EXPECT_EQ(frames[i].stamp, street().scans[i].stamp);
    EXPECT_EQ(frames[i].points, street().scans[i].size());
    EXPECT_GT(frames[i].map_points, 1000U);
    EXPECT_EQ(frames[i].further.size(), odometry->further_columns().size());
    EXPECT_EQ(frames[i].health.registered, i > 0);
    EXPECT_EQ(frames[i].health.observability.degenerate, 0);
    EXPECT_GE(frames[i].health.matches(), i > 0 ? 100U : 0U);
  }
  EXPECT_LT(worst_position_error(frames, street()), within_m());
}

TEST_P(OdometryContract, SaysWhyEachRegistrationEndedAndHowGoodItIs) {
  const auto frames = run(street());
  EXPECT_EQ(frames[0].health.reason, Termination::kNotRun);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const RegistrationHealth& health = frames[i].health;
    EXPECT_TRUE(health.reason == Termination::kConverged ||
                health.reason == Termination::kIterationLimit)
        << name_of(health.reason);
    EXPECT_EQ(health.converged, health.reason == Termination::kConverged);
    const Matrix6 covariance = health.covariance();
    EXPECT_GT(covariance.diagonal().minCoeff(), 0);
    EXPECT_LT(std::sqrt(covariance.diagonal().tail<3>().maxCoeff()), 0.05) << "metres";
    EXPECT_LT(std::sqrt(covariance.diagonal().head<3>().maxCoeff()), 0.005) << "radians";
  }
}

TEST_P(OdometryContract, TellsFramesInOrderAndFinishGivesThoseHeldBack) {
  const auto odometry = make();
  EXPECT_TRUE(odometry->finish().empty()) << "of no scan";
  std::size_t told = 0;
  std::size_t held_back = 0;
  for (std::size_t i = 0; i < street().scans.size(); ++i) {
    const auto frames = odometry->process(street().scans[i]);
    for (const Frame& frame : frames) EXPECT_EQ(frame.index, told++);
    if (frames.empty()) {
      EXPECT_EQ(told, 0U) << "only the start is held back";
      held_back = i + 1;
    } else {
      EXPECT_EQ(told, i + 1) << "what is known is told at once";
    }
  }
  EXPECT_GT(held_back, 0U);
  EXPECT_LT(held_back, street().scans.size());
  EXPECT_TRUE(odometry->finish().empty()) << "everything was told";
}

TEST_P(OdometryContract, ARecordingShorterThanTheStartIsNotLost) {
  for (const std::size_t count : {1U, 2U, 3U}) {
    SimulatedDrive drive = street();
    drive.scans.resize(count);
    const auto odometry = make();
    const auto frames = testing::frames_of(*odometry, drive);
    ASSERT_EQ(frames.size(), count);
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(frames[i].index, i);
    EXPECT_LT(worst_position_error(frames, drive), 0.1);
    EXPECT_TRUE(odometry->finish().empty()) << "told once";
  }
}

TEST_P(OdometryContract, SameBitsOnRepeatAndForAnyNumberOfThreads) {
  const auto imu = testing::simulated_gyro(swerve().drive, -0.1, 1.6);
  const auto one = testing::frames_of(*make(), swerve(), imu);
  for (const int threads : {1, 2, 4}) {
    Making how;
    how.threads = threads;
    const auto many = testing::frames_of(*make(how), swerve(), imu);
    expect_same_frames(one, many, std::to_string(threads) + " threads");
  }
}

TEST_P(OdometryContract, ACloneGoesOnAlikeAndBothAreIndependent) {
  const auto whole = run(street());
  for (const std::size_t at : {0U, 2U, 9U}) {  // before, within and after the start
    const auto original = make();
    std::vector<Frame> frames;
    const auto feed = [&](Odometry& odometry, std::size_t from, std::size_t to,
                          std::vector<Frame>& told) {
      for (std::size_t i = from; i < to; ++i) {
        for (const Frame& frame : odometry.process(street().scans[i])) told.push_back(frame);
      }
    };
    feed(*original, 0, at, frames);
    const auto clone = original->clone();
    EXPECT_EQ(clone->deskew_note(), original->deskew_note());
    EXPECT_EQ(clone->local_map(), original->local_map());
    std::vector<Frame> of_clone = frames;
    feed(*clone, at, whole.size(), of_clone);
    expect_same_frames(whole, of_clone, "a clone after " + std::to_string(at) + " scans");
    feed(*original, at, whole.size(), frames);  // which the clone has not disturbed
    expect_same_frames(whole, frames, "the original cloned after " + std::to_string(at));
  }
}

TEST_P(OdometryContract, ItsMemoryIsTold) {
  const auto odometry = make();
  const std::size_t empty = odometry->bytes();
  for (const auto& scan : street().scans) odometry->process(scan);
  EXPECT_GT(odometry->bytes(), empty + 10'000);
  EXPECT_GT(odometry->bytes(), sizeof(Eigen::Vector3d) * odometry->local_map().size() / 2);
}

TEST_P(OdometryContract, ShowsItsMatchesAndItsMap) {
  const auto odometry = make();
  EXPECT_TRUE(odometry->matches().empty());
  EXPECT_TRUE(odometry->local_map().empty());
  std::vector<Frame> frames;
  for (const auto& scan : street().scans) frames = odometry->process(scan);
  testing::expect_consistent_view(*odometry, frames.back(), GetParam().map_spacing_m);
}

TEST_P(OdometryContract, ShowsAScanAsItUsesIt) {
  const auto odometry = make();
  const sensors::LidarScan& scan = street().scans[3];
  geometry::Twist velocity = geometry::Twist::Zero();
  const CorrectedScan still = odometry->used_scan(scan, velocity, false);
  EXPECT_TRUE(still.classes.empty());
  velocity[3] = 12;
  const CorrectedScan moved = odometry->used_scan(scan, velocity, true);
  ASSERT_GT(moved.x.size(), scan.size() / 2);
  EXPECT_EQ(moved.classes.size(), moved.x.size());
  ASSERT_EQ(moved.source, still.source);
  for (std::size_t i = 0; i < moved.x.size(); ++i) {
    ASSERT_LT(moved.source[i], scan.size());
    EXPECT_NEAR(moved.x[i] - still.x[i], 12 * scan.time[moved.source[i]], 2e-4);
  }
  Making raw;
  raw.deskew = false;
  EXPECT_EQ(make(raw)->used_scan(scan, velocity, false).x, still.x);
}

TEST_P(OdometryContract, WithoutASearchForTheSpeedNothingIsHeldBack) {
  Making how;
  how.from_rest = true;
  const auto odometry = make(how);
  for (const auto& scan : street().scans) EXPECT_EQ(odometry->process(scan).size(), 1U);
  EXPECT_TRUE(odometry->finish().empty());
}

TEST_P(OdometryContract, WithoutDeskewASwervingDriveIsWorse) {
  Making raw;
  raw.deskew = false;
  const double with_deskew = worst_position_error(run(swerve()), swerve());
  EXPECT_LT(with_deskew, 0.15);
  EXPECT_GT(worst_position_error(run(swerve(), raw), swerve()), 2 * with_deskew);
}

TEST_P(OdometryContract, SaysWhyItDoesNotDeskew) {
  Making how;
  EXPECT_EQ(make(how)->deskew_note(), "on");
  how.motion_compensated = true;
  EXPECT_EQ(make(how)->deskew_note(), "off: the recording is motion-compensated");
  how.motion_compensated = false;
  how.profile.time_source = sensors::TimeSource::kNone;
  EXPECT_EQ(make(how)->deskew_note(), "off: point times are unknown");
}

TEST_P(OdometryContract, ADroppedScanDoesNotBreakThePrediction) {
  SimulatedDrive drive = street();
  drive.scans.erase(drive.scans.begin() + 8, drive.scans.begin() + 11);  // a gap of 0.4 s
  drive.truth.erase(drive.truth.begin() + 8, drive.truth.begin() + 11);
  EXPECT_LT(worst_position_error(run(drive), drive), 0.1);
}

TEST_P(OdometryContract, AScanOfNoOrThreePointsKeepsThePredictionAndSaysSo) {
  for (const std::size_t points : {0U, 3U}) {
    SimulatedDrive drive = street();
    drive.scans[10] = cut(drive.scans[10], points);
    const auto frames = run(drive);
    ASSERT_EQ(frames.size(), drive.scans.size());
    EXPECT_EQ(frames[10].points, points);
    EXPECT_FALSE(frames[10].health.registered);
    EXPECT_EQ(frames[10].health.reason, Termination::kTooFewMatches);
    EXPECT_EQ(frames[10].health.observability.degenerate, 6);
    EXPECT_TRUE(frames[11].health.registered);
    EXPECT_LT(worst_position_error(frames, drive), 0.15);
  }
}

TEST_P(OdometryContract, AFirstScanWithoutPointsIsNoMap) {
  SimulatedDrive drive = street();
  drive.scans[0] = cut(drive.scans[0], 0);
  const auto frames = run(drive);
  ASSERT_EQ(frames.size(), drive.scans.size());
  EXPECT_FALSE(frames[1].health.registered);
  EXPECT_TRUE(frames[3].health.registered);
}

TEST_P(OdometryContract, NothingButEmptyScansIsSurvived) {
  SimulatedDrive drive = street();
  for (auto& scan : drive.scans) scan = cut(scan, 0);
  const auto frames = run(drive);
  ASSERT_EQ(frames.size(), drive.scans.size());
  for (const Frame& frame : frames) {
    EXPECT_FALSE(frame.health.registered);
    EXPECT_EQ(frame.T_map_lidar.matrix(), Eigen::Matrix4d::Identity());
  }
}

TEST_P(OdometryContract, PointsThatAreNotFiniteOrBeyondTheRingsAreCountedNotUsed) {
  SimulatedDrive drive = street();
  std::size_t not_finite = 0;
  std::size_t beyond = 0;
  for (auto& scan : drive.scans) {
    not_finite = beyond = 0;
    for (std::size_t i = 0; i + 3 < scan.size(); i += 50) {
      scan.x[i] = std::numeric_limits<float>::quiet_NaN();
      scan.y[i + 1] = std::numeric_limits<float>::infinity();
      scan.ring[i + 2] = 64;
      scan.ring[i + 3] = 0xffff;
      not_finite += 2;
      beyond += 2;
    }
  }
  const auto frames = run(drive);
  EXPECT_EQ(frames.back().dropped.not_finite, not_finite);
  EXPECT_EQ(frames.back().dropped.beyond_profile_rings, beyond);
  EXPECT_LT(worst_position_error(frames, drive), within_m());
}

TEST_P(OdometryContract, StampsThatStandStillOrGoBackGiveFrames) {
  for (const std::size_t at : {1U, 9U}) {  // within the start, and after it
    for (const double shift_s : {0.0, -0.04}) {
      SimulatedDrive drive = street();
      const auto place = static_cast<std::ptrdiff_t>(at);
      sensors::LidarScan again = drive.scans[at];
      again.stamp = geometry::shifted(again.stamp, shift_s);
      drive.scans.insert(drive.scans.begin() + place + 1, again);
      drive.truth.insert(drive.truth.begin() + place, drive.truth[at]);
      const auto frames = run(drive);
      ASSERT_EQ(frames.size(), drive.scans.size());
      EXPECT_EQ(frames[at + 1].stamp, again.stamp);
      for (const Frame& frame : frames) EXPECT_TRUE(frame.T_map_lidar.matrix().allFinite());
      EXPECT_TRUE(frames.back().health.registered);
    }
  }
}

TEST_P(OdometryContract, ScansWithoutRingsAreFollowedOrRefused) {
  SimulatedDrive drive = street();
  if (!GetParam().needs_rings) {
    for (auto& scan : drive.scans) scan.ring.clear();
    EXPECT_LT(worst_position_error(run(drive), drive), 0.1);
    return;
  }
  const auto odometry = make();
  sensors::LidarScan without = drive.scans[0];
  without.ring.clear();
  EXPECT_THROW(odometry->process(without), sensors::NoRings);
  // Refusing one leaves no trace.
  expect_same_frames(run(drive), testing::frames_of(*odometry, drive), "after a refusal");
}

TEST_P(OdometryContract, ATunnelIsReportedDegenerateAndTheEstimateDoesNotJump) {
  const SimulatedDrive drive(simulation::tunnel(100), 16, 8);
  const Eigen::Vector3d axis_map = drive.drive.pose(0).rotation.transpose().col(0);
  const auto frames = run(drive);
  for (std::size_t i = 5; i < frames.size(); ++i) {
    const geometry::Pose3& T_map_lidar = frames[i].T_map_lidar;
    const Observability& seen = frames[i].health.observability;
    EXPECT_GE(seen.degenerate, 1) << i;
    const Eigen::Vector3d weakest = seen.directions.col(0).tail<3>();
    EXPECT_GT(std::abs(weakest.dot(T_map_lidar.rotation.transpose() * axis_map)), 0.9) << i;
    // Nothing tells the speed, so the prediction is rest.
    const Eigen::Vector3d step = T_map_lidar.translation - frames[i - 1].T_map_lidar.translation;
    EXPECT_LT(step.norm(), 0.3) << i;
  }
}

}  // namespace
}  // namespace traverse::lidar
