#include "traverse/loam/scan_to_scan.hpp"

#include <gtest/gtest.h>

#include "geometry/random_motion.hpp"
#include "lidar/simulated_drive.hpp"

namespace traverse::loam {
namespace {

constexpr double kLineStep = 0.3;  // metres of height between the scan lines of made scans

void add(LinedPoints& to, double x, double y, double z, std::size_t line) {
  to.points.push_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), 0);
  to.line.push_back(static_cast<std::uint16_t>(line));
}

lidar::TimedPoints one_point(double x, double y, double z, double time = 0) {
  lidar::TimedPoints points;
  points.push_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z),
                   static_cast<float>(time));
  return points;
}

/// Upright poles at the given places along x, seen by ten scan lines.
LineIndex poles(const std::vector<double>& at_x) {
  LinedPoints points;
  for (std::size_t k = 0; k < 10; ++k) {
    for (const double x : at_x) add(points, x, 5, kLineStep * static_cast<double>(k), k);
  }
  return LineIndex(std::move(points));
}

/// The wall x = 10, seen by `lines` scan lines.
LineIndex wall(std::size_t lines) {
  LinedPoints points;
  for (std::size_t k = 0; k < lines; ++k) {
    for (int i = -20; i <= 20; ++i)
      add(points, 10, 0.25 * i, kLineStep * static_cast<double>(k), k);
  }
  return LineIndex(std::move(points));
}

Matches match(const lidar::TimedPoints& sharp, const lidar::TimedPoints& flat,
              const LineIndex& edges, const LineIndex& planar,
              const geometry::Pose3& T_last_current = {}, const SweepClock& clock = {},
              const ScanToScanOptions& options = {}) {
  return associate_scans(sharp, flat, edges, planar, T_last_current, clock, options, 1);
}

TEST(AssociateScans, ASharpPointFindsThePoleThroughTwoScanLines) {
  const Matches matches = match(one_point(5.1, 5, 1), {}, poles({5, 20}), {});
  ASSERT_EQ(matches.lines.size(), 1U);
  EXPECT_NEAR(std::abs(matches.lines[0].line.direction.z()), 1, 1e-9);
  EXPECT_NEAR(matches.lines[0].line.point.x(), 5, 1e-6);
}

TEST(AssociateScans, TwoPointsOfOneScanLineAreNoLine) {
  LinedPoints points;
  add(points, 5, 5, 1, 3);
  add(points, 5.2, 5, 1, 3);
  EXPECT_EQ(match(one_point(5.1, 5, 1), {}, LineIndex(points), {}).size(), 0U);
  add(points, 5, 5, 3, 6);  // three lines away is not adjacent
  EXPECT_EQ(match(one_point(5.1, 5, 1), {}, LineIndex(points), {}).size(), 0U);
  points.line.back() = 5;
  EXPECT_EQ(match(one_point(5.1, 5, 1), {}, LineIndex(points), {}).size(), 1U);
}

TEST(AssociateScans, AFlatPointFindsTheWallThroughATriangle) {
  const Matches matches = match({}, one_point(9.7, 0.1, 1), {}, wall(10));
  ASSERT_EQ(matches.planes.size(), 1U);
  EXPECT_NEAR(std::abs(matches.planes[0].plane.normal.x()), 1, 1e-9);
  EXPECT_NEAR(std::abs(plane_residual(matches.planes[0].plane, {9.7, 0.1, 1})), 0.3, 1e-6);
}

TEST(AssociateScans, OneScanLineIsNoPlane) {
  EXPECT_EQ(match({}, one_point(9.7, 0.1, 0), {}, wall(1)).size(), 0U);
  EXPECT_EQ(match({}, one_point(9.7, 0.1, 0), {}, wall(2)).size(), 1U);
}

TEST(AssociateScans, ThreePointsThatAreNearlyOnOneLineAreNoPlane) {
  LinedPoints points;
  add(points, 10, 0, 0, 0);
  add(points, 10, 0.4, 0, 0);
  add(points, 10, 0.8, 0.01, 1);
  EXPECT_EQ(match({}, one_point(9.7, 0.1, 0), {}, LineIndex(points)).size(), 0U);
  points.points.z.back() = 0.3F;
  EXPECT_EQ(match({}, one_point(9.7, 0.1, 0), {}, LineIndex(points)).size(), 1U);
}

TEST(AssociateScans, PointsOfOneScanLineThatTouchAreNoBaseline) {
  LinedPoints points;
  add(points, 10, 0, 0, 0);
  add(points, 10.02, 0.01, 0, 0);  // noise: the normal through these two would be anything
  add(points, 10, 0, 0.3, 1);
  EXPECT_EQ(match({}, one_point(9.7, 0, 0), {}, LineIndex(points)).size(), 0U);
}

TEST(AssociateScans, PartnersBeyondTheRadiusDoNotCount) {
  EXPECT_EQ(match(one_point(10.1, 5, 1), one_point(4.9, 0, 1), poles({5}), wall(10)).size(), 0U);
  EXPECT_EQ(match(one_point(9.8, 5, 1), one_point(5.2, 0, 1), poles({5}), wall(10)).size(), 2U);
}

TEST(AssociateScans, APointLooksWhereItWasAtItsOwnTime) {
  geometry::Pose3 T_last_current;
  T_last_current.translation = {2, 0, 0};  // in 0.1 s
  const SweepClock clock{0.1};
  // Seen half a sweep before the stamp the lidar had moved 1 m, so the pole at 6 stands at 5.
  const lidar::TimedPoints early = one_point(5, 5, 1, -0.05);
  const Matches matches = match(early, {}, poles({6, 7}), {}, T_last_current, clock);
  ASSERT_EQ(matches.lines.size(), 1U);
  EXPECT_NEAR(matches.lines[0].line.point.x(), 6, 1e-6);
  EXPECT_NEAR(matches.lines[0].fraction, 0.5, 1e-6);
  EXPECT_EQ(matches.lines[0].p_lidar, early.point(0)) << "the solver moves it";

  const Matches at_stamp = match(early, {}, poles({6, 7}), {}, T_last_current, SweepClock{});
  EXPECT_NEAR(at_stamp.lines[0].line.point.x(), 7, 1e-6);
  EXPECT_EQ(at_stamp.lines[0].fraction, 1);
}

/// Two scans of a street 0.1 s apart, at the given drive.
struct TwoSweeps {
  testing::SimulatedDrive drive;
  std::vector<SweepFeatures> sweeps;
  geometry::Pose3 truth;
  geometry::Twist last_velocity;  // that deskews the first
  lidar::StageTimes ms;

  explicit TwoSweeps(const simulation::Drive& vehicle)
      : drive(simulation::street(60, 1), 2, vehicle),
        truth(drive.truth[1]),
        last_velocity(velocity()) {
    for (const auto& scan : drive.scans) {
      const lidar::ScanLines lines = lidar::organise(scan, drive.scanner.profile);
      sweeps.push_back(collect_sweep(scan, drive.scanner.profile, lines,
                                     extract_features(lines, FeatureOptions{}), 0.2));
    }
  }

  geometry::Twist velocity() const { return geometry::log_se3(truth) / 0.1; }

  ScanMotion follow(const ScanToScanOptions& options, const geometry::Twist& guess_velocity,
                    int threads = 1) {
    SolverOptions solver;
    solver.line_form = LineForm::kVector;
    ScanToScan stage(options, solver, true, threads);
    stage.remember(sweeps[0], last_velocity, ms);
    return stage.follow(sweeps[1],
                        {0.1, geometry::exp_se3(0.1 * guess_velocity), guess_velocity, false}, ms);
  }

  double error(const ScanMotion& motion) const {
    return geometry::log_se3(truth.inverse() * motion.T_last_current).norm();
  }
};

ScanToScanOptions with(SweepMotion sweep_motion) {
  ScanToScanOptions options;
  options.sweep_motion = sweep_motion;
  return options;
}

TEST(ScanToScan, FindsTheMotionBetweenTwoScans) {
  TwoSweeps street(testing::swerving());
  for (const SweepMotion sweep_motion : {SweepMotion::kDeskew, SweepMotion::kPerPoint}) {
    const ScanMotion motion = street.follow(with(sweep_motion), street.velocity());
    EXPECT_TRUE(motion.health.registered);
    EXPECT_EQ(motion.health.steps, 2);
    EXPECT_EQ(motion.health.observability.degenerate, 0);
    EXPECT_GT(motion.health.line_matches, 50U);
    EXPECT_GT(motion.health.plane_matches, 500U);
    EXPECT_LT(street.error(motion), 0.03);  // of 1.2 m; range noise 2 cm
  }
}

TEST(ScanToScan, UndoingTheSweepsMotionNeedsNoGoodPrediction) {
  TwoSweeps street(testing::swerving());
  geometry::Twist wrong = street.velocity();
  wrong[2] += 0.3;  // rad/s
  wrong[3] -= 3;    // m/s: 15 cm over half a sweep
  ScanToScanOptions options = with(SweepMotion::kPerPoint);
  EXPECT_LT(street.error(street.follow(options, wrong)), 0.03);
  options.sweep_motion = SweepMotion::kDeskew;
  options.steps = 1;  // so that only the prediction deskews
  EXPECT_GT(street.error(street.follow(options, wrong)), 0.06);
  options.steps = 4;  // each with a better deskew
  EXPECT_LT(street.error(street.follow(options, wrong)), 0.03);
}

TEST(ScanToScan, TheLastSweepIsDeskewedByItsMotion) {
  TwoSweeps street(testing::swerving());
  street.sweeps[1].sharp.clear();  // planes alone; lines would hide a bent floor
  const ScanToScanOptions options = with(SweepMotion::kPerPoint);
  const double straight = street.error(street.follow(options, street.velocity()));
  street.last_velocity.setZero();
  EXPECT_GT(street.error(street.follow(options, street.velocity())), 2 * straight);
}

TEST(ScanToScan, IsTheSameForAnyNumberOfThreads) {
  TwoSweeps street(testing::swerving());
  for (const SweepMotion sweep_motion : {SweepMotion::kDeskew, SweepMotion::kPerPoint}) {
    const auto one = street.follow(with(sweep_motion), street.velocity());
    for (const int threads : {2, 4}) {
      const auto many = street.follow(with(sweep_motion), street.velocity(), threads);
      EXPECT_EQ(one.T_last_current.matrix(), many.T_last_current.matrix()) << threads;
    }
  }
}

TEST(MotionPrediction, AMeasuredTurnIsKeptAndAnUnknownIntervalKeepsAll) {
  MotionPrediction prediction;
  prediction.velocity << 0, 0, 0.5, 10, 0, 0;
  geometry::Pose3 found;
  found.translation = {1.2, 0, 0};
  EXPECT_EQ(prediction.velocity_given(found), prediction.velocity);
  prediction.interval_s = 0.1;
  geometry::Twist expected;
  expected << 0, 0, 0, 12, 0, 0;
  EXPECT_LT((prediction.velocity_given(found) - expected).norm(), 1e-9);
  prediction.turn_is_measured = true;
  expected[2] = 0.5;
  EXPECT_LT((prediction.velocity_given(found) - expected).norm(), 1e-9);
}

TEST(ScanToScan, WithNoFeaturesOrThreeTheGuessStands) {
  TwoSweeps street(testing::swerving());
  const lidar::TimedPoints flat = street.sweeps[1].flat;
  for (const std::size_t count : {0U, 3U}) {
    street.sweeps[1] = SweepFeatures{};
    for (std::size_t i = 0; i < count; ++i) {
      street.sweeps[1].flat.push_back(flat.x[i], flat.y[i], flat.z[i], flat.time[i]);
    }
    const ScanMotion motion = street.follow(with(SweepMotion::kPerPoint), street.velocity());
    EXPECT_FALSE(motion.health.registered);
    EXPECT_EQ(motion.health.observability.degenerate, 6);
    EXPECT_LE(motion.health.plane_matches, count);
    EXPECT_EQ(motion.T_last_current.matrix(), geometry::exp_se3(0.1 * street.velocity()).matrix());
  }
}

TEST(ScanToScan, BeforeAnyScanIsRememberedTheGuessStands) {
  TwoSweeps street(testing::swerving());
  const ScanToScan stage({}, {}, true, 1);
  const auto motion =
      stage.follow(street.sweeps[1], {0.1, street.truth, street.velocity(), false}, street.ms);
  EXPECT_FALSE(motion.health.registered);
  EXPECT_EQ(motion.T_last_current.matrix(), street.truth.matrix());
}

}  // namespace
}  // namespace traverse::loam
