#include "traverse/loam/frame_correspondences.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "traverse/files/json_document.hpp"
#include "traverse/loam/factor_bench.hpp"

#include "lidar/simulated_drive.hpp"
#include "point_motion.hpp"

namespace traverse::loam {
namespace {

class FrameCorrespondencesTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    street_ = new testing::SimulatedDrive(simulation::street(60, 1), 3, 5);
  }
  static void TearDownTestSuite() { delete street_; }

  static FrameCorrespondences frame(bool motion_compensated) {
    ScanToMapOdometryOptions options;
    options.start.scans = 0;
    return correspondences_of_last(street_->scans, street_->scanner.profile, motion_compensated,
                                   options);
  }

  static inline testing::SimulatedDrive* street_ = nullptr;
};

TEST_F(FrameCorrespondencesTest, SweptPointsAreThoseOfTheDeskewedOnes) {
  const FrameCorrespondences made = frame(false);
  ASSERT_GT(made.matches.planes.size(), 300U);
  ASSERT_EQ(made.swept.planes.size(), made.matches.planes.size());
  ASSERT_EQ(made.swept.lines.size(), made.matches.lines.size());
  double least = 1;
  double most = 0;
  for (std::size_t i = 0; i < made.matches.planes.size(); ++i) {
    const PlaneMatch& deskewed = made.matches.planes[i];
    const PlaneMatch& swept = made.swept.planes[i];
    least = std::min(least, swept.fraction);
    most = std::max(most, swept.fraction);
    EXPECT_EQ(deskewed.fraction, 1);
    // Both are one distance: in the map, and at the begin of the sweep. Exp(s Log R), s t is not
    // quite the motion along the screw that deskew takes: half a metre, some hundredths of a
    // radian.
    const double in_map = plane_residual(deskewed.plane, made.guess_T_map_lidar * deskewed.p_lidar);
    const double at_begin = plane_residual(
        swept.plane, part_of(made.guess_T_begin_end, swept.fraction) * swept.p_lidar);
    EXPECT_NEAR(in_map, at_begin, 2e-3);
  }
  EXPECT_LT(least, 0.05);
  EXPECT_GT(most, 0.95);
  EXPECT_NEAR(made.guess_T_begin_end.translation.norm(), 0.5, 0.1);
}

TEST_F(FrameCorrespondencesTest, WithoutDeskewThereAreNoSweptOnes) {
  const FrameCorrespondences made = frame(true);
  EXPECT_GT(made.matches.size(), 300U);
  EXPECT_EQ(made.swept.size(), 0U);
}

TEST_F(FrameCorrespondencesTest, OneScanIsTooFew) {
  const std::span<const sensors::LidarScan> scans(street_->scans);
  EXPECT_THROW(correspondences_of_last(scans.first(1), street_->scanner.profile, false, {}),
               std::invalid_argument);
}

TEST_F(FrameCorrespondencesTest, AreMeasuredWithEveryDerivative) {
  const FrameCorrespondences made = frame(false);
  const FactorBench bench = measure_factors(made, SolverOptions{}, 3);
  EXPECT_EQ(bench.evaluations.size(), 24U);
  EXPECT_EQ(bench.solves.size(), 12U);
  for (const SolveCost& cost : bench.solves) {
    EXPECT_GT(cost.milliseconds.median, 0);
    EXPECT_LT(cost.from_analytic_m, 1e-7) << name_of(cost.derivative);
  }
  const auto read = [](const std::string& json) {
    return factor_bench_from_json(files::JsonDocument::parse(json).root());
  };
  EXPECT_EQ(to_json(read(to_json(bench))), to_json(bench));
  EXPECT_THROW(read("{}"), files::InputError);
  EXPECT_TRUE(measure_factors({}, SolverOptions{}, 3).evaluations.empty()) << "nothing to measure";
}

}  // namespace
}  // namespace traverse::loam
