#include <memory>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/geometry/angle.hpp"
#include "traverse/geometry/so3.hpp"
#include "traverse/plausibility/reference_checks.hpp"

#include "plausibility/made_recording.hpp"

namespace traverse::plausibility {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using namespace traverse::testing;  // made recordings
using geometry::Pose3;
using geometry::Stamp;
using geometry::Trajectory;
using sensors::ImuSample;

/// The car's IMU and the path of a lidar on it, as odometry tells it, ten poses a second.
struct DriveWithOdometry {
  SimulatedVehicle car;
  MadeRecording recording;
  Trajectory path;

  explicit DriveWithOdometry(double seconds = 60) {
    car.light_every_s = 40;  // a town: speeds change
    const SimulatedDrive drive = simulate(car, {}, seconds);
    recording.info.rig.sensors.push_back({"lidar", sensors::SensorKind::kLidar, {}, std::nullopt});
    recording.info.rig.sensors.push_back({"IMU", sensors::SensorKind::kImu, {}, std::nullopt});
    for (ImuSample sample : drive.imu) {
      sample.sensor = "IMU";
      recording.measurements.emplace_back(sample);
    }
    for (std::size_t k = 0; k < drive.truth.size(); k += 10) {
      path.push_back(Stamp::from_seconds(1000 + 0.01 * static_cast<double>(k)), drive.truth[k]);
    }
  }

  std::vector<Finding> findings() const {
    StreamChecks checks(recording.info);
    std::size_t pose = 0;
    for (const auto& measurement : recording.measurements) {
      checks.take(measurement);
      for (; pose < path.size() && path.stamp(pose) <= sensors::stamp_of(measurement); ++pose) {
        checks.take_pose(path.stamp(pose), path.pose(pose));
      }
    }
    return checks.findings();
  }

  /// The same with every moment of the lidar told so much later.
  void delay(double seconds) {
    Trajectory late;
    for (std::size_t k = 0; k < path.size(); ++k) {
      late.push_back(geometry::shifted(path.stamp(k), seconds), path.pose(k));
    }
    path = late;
  }
  void mount_imu(const Eigen::Matrix3d& R_body_imu) {
    recording.for_each<ImuSample>([&](ImuSample& sample) {
      sample.angular_rate = R_body_imu.transpose() * sample.angular_rate;
      sample.specific_force = R_body_imu.transpose() * sample.specific_force;
    });
  }
};

Eigen::Matrix3d roll_pitch_yaw(double roll_deg, double pitch_deg, double yaw_deg) {
  return geometry::exp_so3({0, 0, yaw_deg * geometry::kDegree}) *
         geometry::exp_so3({0, pitch_deg * geometry::kDegree, 0}) *
         geometry::exp_so3({roll_deg * geometry::kDegree, 0, 0});
}

TEST(MotionChecks, SayNothingOfADriveThatIsRight) {
  DriveWithOdometry drive;
  EXPECT_THAT(drive.findings(), IsEmpty()) << texts_of(drive.findings());
}

TEST(MotionChecks, AMountingThatIsNotStatedIsFound) {
  // Turns about z alone do not tell a yaw of the mounting: hills and bends do.
  for (const auto& rpy : {Eigen::Vector3d(90, 0, 0), Eigen::Vector3d(0, 40, 0),
                          Eigen::Vector3d(180, 0, 0), Eigen::Vector3d(20, -90, 10)}) {
    DriveWithOdometry drive;
    const Eigen::Matrix3d R = roll_pitch_yaw(rpy.x(), rpy.y(), rpy.z());
    drive.mount_imu(R);
    const auto findings = drive.findings();
    const auto found = std::find_if(findings.begin(), findings.end(),
                                    [](const Finding& f) { return f.code == "imu_mounting"; });
    ASSERT_NE(found, findings.end()) << rpy.transpose() << "\n" << texts_of(findings);
    EXPECT_THAT(found->statement, HasSubstr("vehicle.imu.roll_pitch_yaw_deg"));
    drive.recording.info.rig.sensors[1].T_body_sensor.rotation = R;
    EXPECT_THAT(drive.findings(), IsEmpty()) << rpy.transpose() << texts_of(drive.findings());
  }
  DriveWithOdometry sloppy;
  sloppy.mount_imu(roll_pitch_yaw(5, -5, 8));
  EXPECT_THAT(sloppy.findings(), IsEmpty()) << texts_of(sloppy.findings());
}

TEST(MotionChecks, StampsOfAnotherMomentOfTheSweepAreFound) {
  for (const double delay : {0.05, -0.05, 0.1, 0.4, 3.0}) {
    DriveWithOdometry drive(90);
    drive.delay(delay);
    const auto findings = drive.findings();
    ASSERT_THAT(codes_of(findings), ElementsAre("lidar_late")) << delay << texts_of(findings);
    EXPECT_THAT(findings[0].figure, HasSubstr(fmt::format("{:.2f}", std::abs(delay)).substr(0, 3)));
  }
  DriveWithOdometry close(90);
  close.delay(0.01);
  EXPECT_THAT(close.findings(), IsEmpty()) << texts_of(close.findings());
}

/// A path with hills, and a reference made of it.
struct Paths {
  Trajectory estimate = DriveWithOdometry(90).path;
  Trajectory reference;

  template <typename Change>
  explicit Paths(const Change& change) {
    std::mt19937 generator(11);
    std::normal_distribution<double> noise(0, 0.05);
    for (std::size_t k = 0; k < estimate.size(); ++k) {
      Pose3 pose = estimate.pose(k);
      pose.translation += Eigen::Vector3d{noise(generator), noise(generator), noise(generator)};
      // In a map of its own.
      pose = Pose3{roll_pitch_yaw(0, 0, 70), Eigen::Vector3d(100, -20, 3)} * pose;
      Stamp stamp = estimate.stamp(k);
      change(stamp, pose);
      reference.push_back(stamp, pose);
    }
  }
  std::vector<std::string> codes() const {
    return codes_of(reference_findings(estimate, reference));
  }
};

TEST(ReferenceChecks, SayNothingOfAReferenceThatIsRight) {
  EXPECT_THAT(Paths([](Stamp&, Pose3&) {}).codes(), IsEmpty());
  EXPECT_THAT(Paths([](Stamp&, Pose3& pose) {
                pose = pose * Pose3{roll_pitch_yaw(0, 0, 5), Eigen::Vector3d(0.5, 0.2, 1)};
              }).codes(),
              IsEmpty());
  // A receiver tells no orientation.
  EXPECT_THAT(Paths([](Stamp&, Pose3& pose) { pose.rotation.setIdentity(); }).codes(), IsEmpty());
}

TEST(ReferenceChecks, ItsClock) {
  for (const double late : {0.1, -0.3, 5.0, 18.0}) {
    const Paths paths([&](Stamp& stamp, Pose3&) { stamp = geometry::shifted(stamp, late); });
    const auto findings = reference_findings(paths.estimate, paths.reference);
    ASSERT_FALSE(findings.empty()) << late;
    EXPECT_EQ(findings.front().code, "reference_late");
    EXPECT_THAT(findings.front().figure, HasSubstr(late > 0 ? "before" : "after"));
  }
}

TEST(ReferenceChecks, ItsUnitHandAndDirection) {
  EXPECT_THAT(Paths([](Stamp&, Pose3& pose) { pose.translation *= 100; }).codes(),
              ElementsAre("reference_scale"));
  EXPECT_THAT(Paths([](Stamp&, Pose3& pose) { pose.translation *= 0.6; }).codes(),
              ElementsAre("reference_scale"));
  EXPECT_THAT(Paths([](Stamp&, Pose3& pose) { pose = pose.inverse(); }).codes(),
              ElementsAre("reference_inverted"));
}

TEST(ReferenceChecks, ItsAxes) {
  Eigen::Matrix3d R_body_camera;
  R_body_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const Paths camera([&](Stamp&, Pose3& pose) {
    pose = pose * Pose3{R_body_camera, Eigen::Vector3d(1, 0, 0)};
  });
  const auto findings = reference_findings(camera.estimate, camera.reference);
  ASSERT_THAT(codes_of(findings), ElementsAre("reference_frame"));
  EXPECT_THAT(findings.front().statement, HasSubstr("--reference-frame camera"));
  // North, east, down of a body whose z points down.
  const Paths ned([&](Stamp&, Pose3& pose) {
    pose = Pose3{roll_pitch_yaw(180, 0, 90), Eigen::Vector3d::Zero()} * pose *
           Pose3{roll_pitch_yaw(180, 0, 0), Eigen::Vector3d::Zero()};
  });
  EXPECT_THAT(ned.codes(), ElementsAre("reference_frame"));
}

}  // namespace
}  // namespace traverse::plausibility
