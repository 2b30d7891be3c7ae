#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "traverse/config/document.hpp"
#include "traverse/config/settings.hpp"
#include "traverse/dataset/open_recording.hpp"
#include "traverse/geometry/so3.hpp"
#include "traverse/loam/frame_correspondences.hpp"
#include "traverse/loam/registration.hpp"

#include "lidar/simulated_drive.hpp"
#include "test_data.hpp"

namespace traverse::loam {
namespace {

using optimization::Derivative;
using optimization::Perturbation;

/// Every combination of forms, derivative and perturbation: 2 x 2 x 3 x 2.
std::vector<SolverOptions> all_choices() {
  std::vector<SolverOptions> choices;
  for (const LineForm line : {LineForm::kVector, LineForm::kDistance}) {
    for (const PlaneForm plane : {PlaneForm::kSigned, PlaneForm::kAbsolute}) {
      for (const auto& [derivative_name, derivative] : optimization::kDerivativeNames) {
        for (const auto& [side_name, side] : optimization::kPerturbationNames) {
          SolverOptions options;
          options.line_form = line;
          options.plane_form = plane;
          options.derivative = derivative;
          options.perturbation = side;
          options.iterations = 50;  // until the cost stands still
          choices.push_back(options);
        }
      }
    }
  }
  return choices;
}

std::string describe(SolverOptions options) {
  return config::to_yaml([&](config::Binder& b) { bind(b, options); }, false);
}

void expect_near(const geometry::Pose3& a, const geometry::Pose3& b, double metres, double radians,
                 const SolverOptions& options) {
  const geometry::Pose3 difference = a.inverse() * b;
  EXPECT_LT(difference.translation.norm(), metres) << describe(options);
  EXPECT_LT(geometry::angle_of(difference.rotation), radians) << describe(options);
}

/// All choices reach one pose from the same matches: with the same line residual along the same
/// steps, so to 1e-8 m and 1e-9 rad, or 1e-6 m and 1e-8 rad by differences, which see the kinks of
/// the absolute forms. The two line residuals have one minimum but different steps to
/// it, and Ceres ends when a step lowers the cost by less than a millionth of it: to 0.5 mm and
/// 2e-5 rad.
void expect_one_pose(const Matches& matches, const geometry::Pose3& guess) {
  ASSERT_GT(matches.lines.size(), 50U);
  ASSERT_GT(matches.planes.size(), 300U);
  const std::vector<SolverOptions> choices = all_choices();
  ASSERT_EQ(choices.size(), 24U);
  std::map<LineForm, geometry::Pose3> first;
  for (const SolverOptions& options : choices) {
    const SolveResult result = solve_pose(matches, guess, options);
    ASSERT_TRUE(result.usable) << describe(options);
    EXPECT_GT((guess.inverse() * result.T_map_lidar).translation.norm(), 0.02) << "it moved";
    const auto [same_form, inserted] = first.emplace(options.line_form, result.T_map_lidar);
    if (options.derivative == Derivative::kNumeric) {
      expect_near(same_form->second, result.T_map_lidar, 1e-6, 1e-8, options);
    } else {
      expect_near(same_form->second, result.T_map_lidar, 1e-8, 1e-9, options);
    }
    expect_near(first.at(LineForm::kVector), result.T_map_lidar, 5e-4, 2e-5, options);
  }
}

ScanToMapOdometryOptions without_speed_search() {
  ScanToMapOdometryOptions options;
  options.start.scans = 0;
  return options;
}

/// A prediction that is off by what a vehicle's change of speed between two scans makes.
geometry::Pose3 disturbed(const geometry::Pose3& guess) {
  geometry::Twist error;
  error << 0.004, -0.003, 0.006, 0.1, 0.05, -0.03;
  return guess * geometry::exp_se3(error);
}

const FrameCorrespondences& simulated_frame() {
  static const FrameCorrespondences kFrame = [] {
    const testing::SimulatedDrive street(simulation::street(60, 1), 3, 5);
    return correspondences_of_last(street.scans, street.scanner.profile, false,
                                   without_speed_search());
  }();
  return kFrame;
}

TEST(SolverChoices, ReachOnePoseOnASimulatedStreet) {
  const FrameCorrespondences& frame = simulated_frame();
  expect_one_pose(frame.matches, disturbed(frame.guess_T_map_lidar));
}

TEST(SolverChoices, ReachOnePoseWithinASimulatedSweep) {
  const FrameCorrespondences& frame = simulated_frame();
  expect_one_pose(frame.swept, disturbed(frame.guess_T_begin_end));
}

/// The first scans of a KITTI drive.
class SolverChoicesOnKitti : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto drive = testing::kitti_drive("2011_09_26_drive_0005");
    if (!std::filesystem::is_directory(drive)) GTEST_SKIP() << testing::kNoDrives;
    dataset::OpenOptions options;
    options.share_folder = TRAVERSE_SHARE_DIR;
    options.statements_file =
        std::filesystem::path(TRAVERSE_SHARE_DIR) / "recordings/kitti_raw_drive.yaml";
    const auto source = dataset::open_recording(drive, options);
    std::vector<sensors::LidarScan> scans;
    while (scans.size() < 4) {
      const auto measurement = source->next();
      ASSERT_TRUE(measurement.has_value());
      scans.push_back(*std::get<std::shared_ptr<const sensors::LidarScan>>(*measurement));
    }
    frame_ = correspondences_of_last(scans, *source->info().rig.sensors.front().lidar, false,
                                     without_speed_search());
  }

  FrameCorrespondences frame_;
};

TEST_F(SolverChoicesOnKitti, ReachOnePose) {
  expect_one_pose(frame_.matches, disturbed(frame_.guess_T_map_lidar));
}

TEST_F(SolverChoicesOnKitti, ReachOnePoseWithinASweep) {
  expect_one_pose(frame_.swept, disturbed(frame_.guess_T_begin_end));
}

TEST(SolverChoices, HaveKeysAndAreRefusedByName) {
  SolverOptions options;
  const auto read = [&](const std::string& yaml) {
    config::read(config::Document::parse(yaml, "test"),
                 [&](config::Binder& b) { bind(b, options); });
  };
  read(
      "line_residual: vector\nplane_residual: absolute\nderivative: automatic\n"
      "perturbation: left\n");
  EXPECT_EQ(options.line_form, LineForm::kVector);
  EXPECT_EQ(options.plane_form, PlaneForm::kAbsolute);
  EXPECT_EQ(options.derivative, Derivative::kAutomatic);
  EXPECT_EQ(options.perturbation, Perturbation::kLeft);
  read("derivative: numeric\n");
  EXPECT_EQ(options.derivative, Derivative::kNumeric);
  EXPECT_ANY_THROW(read("derivative: guessed\n"));
}

}  // namespace
}  // namespace traverse::loam
