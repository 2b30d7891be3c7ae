#include <map>
#include <memory>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/geometry/so3.hpp"
#include "traverse/plausibility/stream_checks.hpp"
#include "traverse/simulation/scanner.hpp"
#include "traverse/simulation/worlds.hpp"

namespace traverse::plausibility {
namespace {

using geometry::Pose3;
using geometry::Stamp;
using sensors::LidarScan;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// What becomes of scans between the lidar and the program.
struct Treatment {
  bool compensate = false;  ///< the points are brought to the stamp
  float time_factor = 1;    ///< of their times; 0: they are taken away
  bool stated_compensated = false;
  double odometry_scale = 1;  ///< of the poses that the estimator tells
};

constexpr int kScans = 40;

/// Raw sweeps of a drive down a street, simulated once for all tests.
const std::vector<LidarScan>& raw_scans(const simulation::Scanner& scanner,
                                        const simulation::Drive& drive) {
  static const simulation::AnalyticScene kStreet = simulation::street(200, 3);
  static std::map<double, std::vector<LidarScan>> known;
  std::vector<LidarScan>& scans = known[drive.speed_mps];
  for (int i = static_cast<int>(scans.size()); i < kScans; ++i) {
    scans.push_back(scanner.scan(kStreet, drive, 0.1 * i));
  }
  return scans;
}

std::vector<Finding> findings_of(double speed_mps, const Treatment& treatment) {
  simulation::Drive drive{speed_mps};
  simulation::Scanner scanner = simulation::demo_scanner();
  scanner.azimuth_steps = 720;
  scanner.range_noise_m = 0.02;
  dataset::RecordingInfo info;
  info.motion_compensated = treatment.stated_compensated;
  sensors::LidarProfile profile = scanner.profile;
  if (treatment.time_factor == 0) profile.time_source = sensors::TimeSource::kNone;
  info.rig.sensors.push_back({"lidar", sensors::SensorKind::kLidar, {}, profile});
  StreamChecks checks(info);
  std::mt19937 generator(5);
  std::normal_distribution<double> normal;
  for (int i = 0; i < kScans; ++i) {
    const double t = 0.1 * i;
    LidarScan scan = raw_scans(scanner, drive)[static_cast<std::size_t>(i)];
    scan.sensor = "lidar";
    const Pose3 T_lidar_map = drive.pose(t).inverse();
    for (std::size_t k = 0; k < scan.size(); ++k) {
      if (treatment.compensate) {
        const Pose3 T = T_lidar_map * drive.pose(t + static_cast<double>(scan.time[k]));
        const Eigen::Vector3f p =
            (T * Eigen::Vector3d(scan.x[k], scan.y[k], scan.z[k])).cast<float>();
        scan.x[k] = p.x();
        scan.y[k] = p.y();
        scan.z[k] = p.z();
      }
      scan.time[k] *= treatment.time_factor;
    }
    if (treatment.time_factor == 0) scan.time.clear();
    scan.stamp = Stamp::from_seconds(100 + t);
    Pose3 pose = drive.pose(0).inverse() * drive.pose(t);
    pose.translation *= treatment.odometry_scale;
    pose.translation +=
        0.02 * Eigen::Vector3d{normal(generator), normal(generator), normal(generator)};
    checks.take(std::make_shared<const LidarScan>(std::move(scan)));
    checks.take_pose(Stamp::from_seconds(100 + t), pose);
  }
  return checks.findings();
}

std::vector<std::string> figures_of(const std::vector<Finding>& findings) {
  std::vector<std::string> codes;
  for (const Finding& finding : findings) codes.push_back(finding.code + ": " + finding.figure);
  return codes;
}

class DeskewChecks : public ::testing::TestWithParam<double> {
 protected:
  std::vector<Finding> look(const Treatment& treatment) const {
    return findings_of(GetParam(), treatment);
  }
};

TEST_P(DeskewChecks, SayNothingOfWhatIsStatedRightly) {
  EXPECT_THAT(figures_of(look({})), IsEmpty());
  EXPECT_THAT(figures_of(look({.compensate = true, .stated_compensated = true})), IsEmpty());
  EXPECT_THAT(figures_of(look({.odometry_scale = 1.03})), IsEmpty());
}

TEST_P(DeskewChecks, FindRawScansThatAreTakenForCompensated) {
  for (const double scale : {1.0, 1.03, 0.97}) {
    const auto findings = look({.stated_compensated = true, .odometry_scale = scale});
    ASSERT_EQ(findings.size(), 1U) << scale;
    EXPECT_EQ(findings[0].code, "scans_not_compensated");
    EXPECT_EQ(findings[0].statement, "--recording motion_compensated=false");
  }
}

TEST_P(DeskewChecks, FindCompensatedScansThatAreTakenForRaw) {
  const auto findings = look({.compensate = true});
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].code, "scans_compensated");
}

TEST_P(DeskewChecks, FindTimesThatRunBack) {
  const auto findings = look({.time_factor = -1});
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].code, "point_times_reversed");
}

TEST_P(DeskewChecks, FindRawScansWithoutTimes) {
  const auto findings = look({.time_factor = 0});
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].code, "point_times_unknown");
  EXPECT_THAT(findings[0].statement, HasSubstr("lidar.rotation=clockwise"));
  EXPECT_THAT(figures_of(look({.compensate = true, .time_factor = 0})), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Speeds, DeskewChecks, ::testing::Values(8.0, 20.0));

TEST(DeskewChecksOfASlowVehicle, SayNothing) {
  EXPECT_THAT(findings_of(0.5, {.stated_compensated = true}), IsEmpty());
}

}  // namespace
}  // namespace traverse::plausibility
