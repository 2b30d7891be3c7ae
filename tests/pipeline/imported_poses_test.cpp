#include "traverse/pipeline/imported_poses.hpp"

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/geometry/so3.hpp"
#include "traverse/pipeline/run.hpp"
#include "traverse/pipeline/run_contents.hpp"

#include "geometry/random_motion.hpp"
#include "lidar/simulated_drive.hpp"
#include "pipeline/made_source.hpp"
#include "temporary_folder.hpp"

namespace traverse::pipeline {
namespace {

using geometry::Pose3;
using geometry::Stamp;
using geometry::Trajectory;
using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::MadeSource;
using testing::TemporaryFolder;

/// A curve whose pose at any time is known.
Pose3 pose_on_curve(double seconds) {
  Pose3 pose;
  pose.rotation = geometry::exp_so3(Eigen::Vector3d(0, 0, 0.1 * seconds));
  pose.translation = {8 * seconds, seconds * seconds, 0.1 * seconds};
  return pose;
}

Trajectory curve(double from_s, double to_s, double step_s) {
  Trajectory path;
  for (int i = 0; from_s + i * step_s <= to_s + 1e-9; ++i) {
    const double seconds = from_s + i * step_s;
    path.push_back(Stamp::from_seconds(seconds), pose_on_curve(seconds));
  }
  return path;
}

class ImportedPosesTest : public ::testing::Test {
 protected:
  ImportedPosesTest() {
    info_.path = folder_ / "recording";
    files::write_text(info_.path, "abc");
    info_.name = "made";
    sensors::MountedSensor lidar;
    lidar.label = "lidar";
    lidar.lidar = sensors::LidarProfile{};
    info_.rig.sensors.push_back(lidar);
  }

  /// Ten scans a second, of a few points.
  static std::vector<sensors::Measurement> scans(int count) {
    std::vector<sensors::Measurement> list;
    for (int i = 0; i < count; ++i) {
      auto scan = std::make_shared<sensors::LidarScan>();
      scan->stamp = Stamp::from_seconds(0.1 * i);
      scan->sensor = "lidar";
      for (int k = 0; k < 50; ++k) {
        scan->x.push_back(8 + 0.05F * static_cast<float>(k));
        scan->y.push_back(static_cast<float>(k % 7));
        scan->z.push_back(0.3F * static_cast<float>(k % 5));
      }
      list.emplace_back(std::shared_ptr<const sensors::LidarScan>(scan));
    }
    return list;
  }

  std::string write(const Trajectory& path, const std::string& name = "poses.tum") const {
    dataset::write_tum(folder_ / name, path);
    return (folder_ / name).string();
  }

  Pipeline pipeline_of(const std::string& file, std::vector<std::string> settings = {}) const {
    settings.push_back("poses.file=" + file);
    return make_pipeline(imported_preset("OTHER", settings), info_, 1);
  }

  /// Imports them over twenty scans; the run stands in folder_ / "run".
  RunRecord import(const std::string& file, const std::vector<std::string>& settings = {}) {
    std::filesystem::remove_all(run_.path);
    MadeSource source(info_, scans(20));
    source.reference_ = reference_;
    Pipeline pipeline = pipeline_of(file, settings);
    return run(source, pipeline, run_, {}, {});
  }

  static std::string decision(const RunRecord& record, const std::string& name) {
    for (const Decision& decided : record.decisions) {
      if (decided.name == name) return decided.value;
    }
    return "nothing";
  }

  TemporaryFolder folder_;
  dataset::RecordingInfo info_;
  std::optional<dataset::Reference> reference_;
  RunFolder run_{folder_ / "run"};
};

TEST_F(ImportedPosesTest, ScansGetThePoseBetweenTheirNeighboursInTime) {
  const RunRecord record = import(write(curve(0, 1.9, 0.04)));
  EXPECT_EQ(record.status, RunStatus::kOk) << record.reason;
  const Trajectory told =
      dataset::read_trajectory(run_.trajectory(), dataset::TrajectoryFormat::kTum);
  ASSERT_EQ(told.size(), 19U);
  for (std::size_t i = 0; i < told.size(); ++i) {
    const Pose3 truth = pose_on_curve(told.stamp(i).seconds());
    // Between poses 0.04 s apart a curve is off the constant twist by its jerk.
    EXPECT_LT((told.pose(i).translation - truth.translation).norm(), 1e-3) << i;
  }
  EXPECT_EQ(decision(record, "scans"),
            "20: 10 at a pose, 9 between poses at most 0.04 s apart (allowed: 0.5 s), 1 after the "
            "last pose");
}

TEST_F(ImportedPosesTest, WhatHasNoPoseIsCountedAndMakesTheRunWorse) {
  Trajectory path = curve(0.35, 0.8, 0.05);
  const Trajectory rest = curve(1.5, 1.9, 0.05);
  for (std::size_t i = 0; i < rest.size(); ++i) path.push_back(rest.stamp(i), rest.pose(i));
  const RunRecord record = import(write(path));
  EXPECT_EQ(record.frames_used, 10U);
  EXPECT_THAT(decision(record, "scans"), HasSubstr("4 before the first pose"));
  EXPECT_THAT(decision(record, "scans"), HasSubstr("6 where poses are more than 0.5 s apart"));
  EXPECT_EQ(record.status, RunStatus::kDegraded);
  EXPECT_EQ(record.health->reasons.front().code, "without_pose");
}

TEST_F(ImportedPosesTest, AnotherClockIsAnErrorUntilItIsStated) {
  Trajectory path;
  const Trajectory here = curve(0, 1.9, 0.1);
  for (std::size_t i = 0; i < here.size(); ++i) {
    path.push_back(geometry::shifted(here.stamp(i), 1000), here.pose(i));
  }
  const std::string file = write(path);
  const RunRecord record = import(file);
  EXPECT_EQ(record.status, RunStatus::kFailed);
  EXPECT_THAT(record.reason, HasSubstr("expected poses at the times of the scans, 0.000000000 to "
                                       "1.900000000 s, found poses of 1000.000000000 to 1001.9"));
  EXPECT_THAT(record.reason, HasSubstr("--time-offset SECONDS, or auto"));
  EXPECT_EQ(import(file, {"poses.time_offset_s=-1000"}).frames_used, 20U);
}

TEST_F(ImportedPosesTest, PosesWithoutStampsGoByTheNumberOfTheScan) {
  const Trajectory path = curve(0, 1.9, 0.1);
  std::string text;
  for (const std::size_t k : {2, 3, 5}) {  // KITTI-360's numbers before the poses
    dataset::write_kitti(folder_ / "one.txt", Trajectory::unstamped({path.pose(k)}));
    text += std::to_string(k) + " " + files::read_text(folder_ / "one.txt");
  }
  files::write_text(folder_ / "numbered.txt", text);
  RunRecord record = import((folder_ / "numbered.txt").string());
  EXPECT_EQ(record.frames_used, 3U);
  EXPECT_THAT(decision(record, "scans"), HasSubstr("1 whose number has no pose"));
  const Trajectory told =
      dataset::read_trajectory(run_.trajectory(), dataset::TrajectoryFormat::kTum);
  EXPECT_EQ(told.stamp(2), Stamp::from_seconds(0.5));
  EXPECT_EQ(told.pose(2).translation, path.pose(5).translation);
  // Of a recording that is read from the third scan on.
  record = import((folder_ / "numbered.txt").string(), {"poses.first_scan=3"});
  EXPECT_EQ(record.frames_used, 2U);
}

TEST_F(ImportedPosesTest, AFrameIsBroughtToTheBody) {
  testing::RandomMotion random(3);
  const Pose3 T_body_lidar = random.pose(0.2, 2);
  const Pose3 T_lidar_imu = random.pose(0.2, 1);
  info_.rig.sensors.front().T_body_sensor = T_body_lidar;
  const Pose3 T_body_imu = T_body_lidar * T_lidar_imu;
  const Trajectory of_body = curve(0, 1, 0.1);
  const Trajectory of_imu =
      of_body.transformed_left(T_body_imu.inverse()).transformed_right(T_body_imu);
  ImportOptions options;
  options.file = write(of_imu);
  const auto q = T_lidar_imu.quaternion();
  const Eigen::Vector3d& t = T_lidar_imu.translation;
  options.extrinsic = {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
  const auto expect_of_body = [&] {
    const ImportedPoses poses = read_imported_poses(options, info_);
    for (std::size_t i = 0; i < of_body.size(); ++i) {
      EXPECT_LT((poses.T_map_body.pose(i).matrix() - of_body.pose(i).matrix()).norm(), 1e-12) << i;
    }
  };
  expect_of_body();
  const auto& R = T_lidar_imu.rotation;
  options.extrinsic = {R(0, 0), R(0, 1), R(0, 2), t.x(),   R(1, 0), R(1, 1),
                       R(1, 2), t.y(),   R(2, 0), R(2, 1), R(2, 2), t.z()};
  expect_of_body();
}

TEST_F(ImportedPosesTest, AxesThatPointUpStayAndThoseOfACameraAreTurned) {
  Pose3 T_body_camera;  // z ahead, x to the right, y down
  T_body_camera.rotation << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  info_.T_body_camera = T_body_camera;
  ImportOptions options;
  options.frame = "camera";
  const Trajectory of_body = curve(0, 1, 0.1);
  for (const bool counts_from_camera : {true, false}) {
    const Trajectory in_world =
        counts_from_camera ? of_body.transformed_left(T_body_camera.inverse()) : of_body;
    options.file = write(in_world.transformed_right(T_body_camera));
    const ImportedPoses poses = read_imported_poses(options, info_);
    EXPECT_LT((poses.T_map_body.pose(7).matrix() - of_body.pose(7).matrix()).norm(), 1e-12)
        << counts_from_camera;
  }
}

TEST_F(ImportedPosesTest, WhatCannotBeIsRefusedByName) {
  ImportOptions options;
  options.file = write(curve(0, 1, 0.1));
  const auto refusal = [&] {
    try {
      read_imported_poses(options, info_);
    } catch (const files::InputError& error) {
      return std::string(error.what());
    }
    return std::string("read");
  };
  options.extrinsic = {1, 2, 3};
  EXPECT_THAT(refusal(), HasSubstr("found 3 numbers"));
  options.extrinsic = {0, 0, 0, 0, 0, 0, 2};
  EXPECT_THAT(refusal(), HasSubstr("a quaternion of length 2"));
  options.extrinsic = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0};
  EXPECT_THAT(refusal(), HasSubstr("found another matrix"));
  options.extrinsic.clear();
  options.frame = "camera";
  EXPECT_THAT(refusal(), HasSubstr("a calibration of camera 0"));
}

TEST_F(ImportedPosesTest, WhatIsNotKnownIsAbsentNotZero) {
  reference_ = dataset::Reference{curve(0, 1.9, 0.1), "truth.tum", "made"};
  const RunRecord record = import(write(curve(0, 1.9, 0.1)));
  ASSERT_EQ(record.status, RunStatus::kOk) << record.reason;
  const json told = json::parse(files::read_text(run_.record()));
  for (const char* key : {"timing_ms", "threads", "wall_seconds", "peak_memory_mb"}) {
    EXPECT_TRUE(told.at(key).is_null()) << key;
  }
  for (const char* key : {"registrable", "registered", "registered_share", "lost", "degenerate",
                          "unsupported", "restarts"}) {
    EXPECT_TRUE(told["health"].at(key).is_null()) << key;
  }
  const RunContents contents = read_run(run_, RunPart::kAll);
  EXPECT_TRUE(contents.health.is_foreign);
  EXPECT_THAT(contents.frames.columns(),
              ElementsAre("frame", "stamp_s", "interpolated", "speed_mps"));
  ASSERT_TRUE(contents.evaluation.comparison);
  EXPECT_LT(contents.evaluation.comparison->ape.front().statistics.rmse, 1e-9);
  EXPECT_GT(contents.map.size(), 0U);
}

TEST_F(ImportedPosesTest, TheScansOfTheWorstSegmentsAreKept) {
  reference_ = dataset::Reference{curve(0, 1.9, 0.1), "truth.tum", "made"};
  import(write(curve(0, 1.9, 0.1)));
  const RunContents contents = read_run(run_, RunPart::kAll);
  ASSERT_TRUE(contents.worst_frames);
  EXPECT_EQ(contents.worst_frames->size() % 50, 0U);
}

TEST_F(ImportedPosesTest, WhatTheOtherProgramCostCanBeTold) {
  const std::string poses = write(curve(0, 1.9, 0.1));
  std::string numbers;
  for (int i = 0; i < 20; ++i) numbers += (i == 0 ? "" : ", ") + std::to_string(10 + i);
  files::write_text(folder_ / "timing.yaml",
                    "threads: 4\npeak_memory_mb: 512\nframe_ms: [" + numbers + "]\n");
  import(poses, {"poses.timing=" + (folder_ / "timing.yaml").string()});
  const json told = json::parse(files::read_text(run_.record()));
  EXPECT_EQ(told["threads"], 4);
  EXPECT_EQ(told["peak_memory_mb"], 512);
  EXPECT_TRUE(told["wall_seconds"].is_null());
  EXPECT_EQ(told["timing_ms"]["total"], 390);
  EXPECT_EQ(read_run(run_, RunPart::kAll).frames.column("total_ms").at(3), 13);

  files::write_text(folder_ / "timing.yaml", "frame_ms: [1, 2]\n");
  try {
    import(poses, {"poses.timing=" + (folder_ / "timing.yaml").string()});
    ADD_FAILURE();
  } catch (const files::InputError& error) {
    EXPECT_EQ(error.expected(), "20 numbers, one for each pose");
    EXPECT_EQ(error.found(), "2");
  }
}

TEST_F(ImportedPosesTest, ScansAreDeskewedByTheMotionOfThePoses) {
  const testing::SimulatedDrive drive(simulation::street(60, 1), 3, testing::swerving());
  info_.rig.sensors.front().lidar = drive.scanner.profile;
  Trajectory path;
  for (int i = -20; i < 40; ++i) {
    const double t = 0.01 * i;
    path.push_back(Stamp::from_seconds(10 + t), drive.drive.pose(t));
  }
  const std::string file = write(path);
  const sensors::LidarScan& scan = drive.scans[1];
  const double stamp_s = scan.stamp.seconds();
  /// How far points are from where they would have been seen at the stamp, the largest.
  const auto distortion_m = [&](const std::string& deskew) {
    const std::string clock = "poses.time_offset_s=" + std::to_string(stamp_s - 10.1);
    Pipeline pipeline = pipeline_of(file, {"poses.deskew=" + deskew, clock});
    std::vector<PoseFrame> frames =
        pipeline.estimator->process(std::make_shared<const sensors::LidarScan>(scan));
    for (PoseFrame& frame : pipeline.estimator->finish()) frames.push_back(std::move(frame));
    const UsedScan used = pipeline.estimator->used_scan(scan, frames.at(0), false);
    double largest = 0;
    for (std::size_t k = 0; k < used.x.size(); ++k) {
      const std::size_t i = used.source[k];
      const Pose3 T_stamp_point =
          drive.drive.pose(0.1).inverse() * drive.drive.pose(0.1 + double{scan.time[i]});
      const Eigen::Vector3d truth =
          T_stamp_point * Eigen::Vector3d(scan.x[i], scan.y[i], scan.z[i]);
      largest =
          std::max(largest, (truth - Eigen::Vector3d(used.x[k], used.y[k], used.z[k])).norm());
    }
    return largest;
  };
  // What is left is that the turn changes within a sweep.
  const double as_recorded_m = distortion_m("false");
  EXPECT_GT(as_recorded_m, 0.5);
  EXPECT_LT(distortion_m("true"), 0.2 * as_recorded_m);
}

}  // namespace
}  // namespace traverse::pipeline
