#include "traverse/pipeline/run.hpp"

#include <fstream>
#include <new>
#include <set>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/evaluation/json.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/json_document.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/optimization/jacobian_audit.hpp"
#include "traverse/pipeline/frame_table.hpp"

#include "file_size_limit.hpp"
#include "pipeline/made_source.hpp"
#include "temporary_folder.hpp"

namespace traverse::pipeline {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::MadeSource;
using ::testing::SizeIs;
using testing::TemporaryFolder;

geometry::Pose3 pose_at(double seconds) {
  geometry::Pose3 pose;
  pose.translation = {10 * seconds, seconds * seconds, 0};
  return pose;
}

/// An estimator that knows the truth and holds the first three scans back.
class KnowingEstimator : public Estimator {
 public:
  const std::vector<std::string>& columns() const override {
    static const std::vector<std::string> kPoints{"points"};
    static const std::vector<std::string> kWithResidual{"points", "residual_rms_m"};
    return residual_rms_m ? kWithResidual : kPoints;
  }
  std::vector<PoseFrame> process(const sensors::Measurement& measurement) override {
    const auto scan = std::get<std::shared_ptr<const sensors::LidarScan>>(measurement);
    PoseFrame frame;
    frame.stamp = scan->stamp;
    frame.T_map_body = pose_at(scan->stamp.seconds());
    frame.milliseconds = 5;
    frame.record = {static_cast<double>(scan->size())};
    if (residual_rms_m) frame.record.push_back(*residual_rms_m);
    if (out_of_memory_at && scan->stamp >= *out_of_memory_at) throw std::bad_alloc();
    if (fail_at && scan->stamp >= *fail_at) throw std::runtime_error("cannot go on");
    held_back_.push_back(frame);
    return held_back_.size() < 3 && !begun_ ? std::vector<PoseFrame>{} : finish();
  }
  std::vector<PoseFrame> finish() override {
    begun_ = true;
    return std::exchange(held_back_, {});
  }
  UsedScan used_scan(const sensors::LidarScan& scan, const PoseFrame&,
                     bool classes) const override {
    UsedScan used{scan.x, scan.y, scan.z, {}, {}};
    if (classes) used.feature_class.assign(scan.size(), 1);
    return used;
  }
  std::string points_are() const override { return "as made"; }
  std::vector<Decision> decisions() const override { return {{"deskew", "off"}}; }
  std::vector<optimization::FactorUse> factors() const override { return uses; }
  std::unique_ptr<Estimator> clone() const override {
    return std::make_unique<KnowingEstimator>(*this);
  }

  std::vector<optimization::FactorUse> uses;
  std::optional<double> residual_rms_m;
  std::optional<geometry::Stamp> fail_at;
  std::optional<geometry::Stamp> out_of_memory_at;

 private:
  bool begun_ = false;
  std::vector<PoseFrame> held_back_;
};

class RunTest : public ::testing::Test {
 protected:
  RunTest() : source_(info(), scans()) {
    files::make_writable_folder(folder_ / "recording");
    files::write_text(folder_ / "recording/data", "abc");
    auto estimator = std::make_unique<KnowingEstimator>();
    estimator_ = estimator.get();
    pipeline_.name = "knowing";
    pipeline_.estimator = std::move(estimator);
  }

  dataset::RecordingInfo info() const {
    dataset::RecordingInfo info;
    info.path = folder_ / "recording";
    info.name = "made";
    info.expected_scans = 20;
    sensors::MountedSensor lidar;
    lidar.label = "lidar";
    lidar.lidar = sensors::LidarProfile{};
    info.rig.sensors.push_back(lidar);
    return info;
  }

  static std::vector<sensors::Measurement> scans() {
    std::vector<sensors::Measurement> list;
    for (int i = 0; i < 20; ++i) {
      auto scan = std::make_shared<sensors::LidarScan>();
      scan->stamp = geometry::Stamp::from_seconds(0.1 * i);
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

  void add_reference(double offset_seconds) {
    dataset::Reference reference;
    reference.file = "truth.tum";
    for (int i = 0; i < 20; ++i) {
      reference.T_map_body.push_back(geometry::Stamp::from_seconds(0.1 * i + offset_seconds),
                                     pose_at(0.1 * i));
    }
    source_.reference_ = reference;
  }

  RunRecord run_all(const RunOptions& options = {}, const RunObserver& observer = {}) {
    return run(source_, pipeline_, run_folder_, options, observer);
  }
  /// The same once more, from the beginning.
  RunRecord run_again() {
    std::filesystem::remove_all(run_folder_.path);
    source_.rewind();
    return run_all();
  }
  json record() const { return json::parse(files::read_text(run_folder_.record())); }

  /// Trajectory, health, map, and evaluation are those of the first `frames` frames.
  void expect_results_of(std::size_t frames) const {
    EXPECT_EQ(
        dataset::read_trajectory(run_folder_.trajectory(), dataset::TrajectoryFormat::kTum).size(),
        frames);
    EXPECT_EQ(FrameTable::read_csv(run_folder_.frames()).rows().size(), frames);
    EXPECT_GT(dataset::read_point_cloud(run_folder_.map_points()).size(), 0U);
    const auto evaluation = evaluation::from_json(files::read_text(run_folder_.evaluation()));
    EXPECT_EQ(evaluation.comparison.has_value(), source_.reference_.has_value());
    EXPECT_EQ(record()["frames"]["used"], frames);
  }

  TemporaryFolder folder_;
  RunFolder run_folder_{folder_ / "run"};
  MadeSource source_;
  Pipeline pipeline_;
  KnowingEstimator* estimator_ = nullptr;
};

TEST_F(RunTest, WritesTheWholeFolderWithEveryFrameOnce) {
  add_reference(0);
  std::vector<std::size_t> progress;
  RunObserver observer;
  observer.frame = [&](std::size_t done) { progress.push_back(done); };
  const RunRecord result = run_all({}, observer);
  EXPECT_EQ(result.status, RunStatus::kOk);
  EXPECT_EQ(progress.size(), 20U);
  EXPECT_EQ(progress.back(), 20U);
  for (const auto& file : {run_folder_.record(), run_folder_.trajectory(), run_folder_.reference(),
                           run_folder_.frames(), run_folder_.map_points(), run_folder_.simple_map(),
                           run_folder_.sample_scan(), run_folder_.evaluation()}) {
    EXPECT_TRUE(std::filesystem::is_regular_file(file)) << file;
  }
  EXPECT_FALSE(std::filesystem::exists(run_folder_.jacobians())) << "it uses no factors";
  EXPECT_EQ(FrameTable::read_csv(run_folder_.frames()).rows().size(), 20U);
  const auto trajectory =
      dataset::read_trajectory(run_folder_.trajectory(), dataset::TrajectoryFormat::kTum);
  EXPECT_LT((trajectory.pose(7).translation - pose_at(0.7).translation).norm(), 1e-12);
  const auto evaluation = evaluation::from_json(files::read_text(run_folder_.evaluation()));
  ASSERT_TRUE(evaluation.comparison);
  EXPECT_LT(evaluation.comparison->path.end_error_m, 1e-9);
  EXPECT_EQ(record()["status"], "ok");
  EXPECT_EQ(record()["frames"]["used"], 20);
  EXPECT_EQ(record()["timing_ms"]["frame_median"], 5);
  EXPECT_EQ(record()["recording"]["bytes"], 3);
}

TEST_F(RunTest, KeepsHowAFrameOfTheWorstSegmentWasRegistered) {
  run_all();
  EXPECT_FALSE(std::filesystem::exists(run_folder_.worst_frames())) << "it tells no residuals";
  estimator_->residual_rms_m = 0.1;
  run_again();
  const auto cloud = dataset::read_point_cloud(run_folder_.worst_frames());
  ASSERT_NE(cloud.find("frame"), nullptr);
  const auto frames = dataset::to_floats(*cloud.find("frame"));
  EXPECT_THAT(std::set<float>(frames.begin(), frames.end()), SizeIs(1)) << "of 20 frames";
  EXPECT_EQ(cloud.size(), 50U);
  EXPECT_TRUE(std::filesystem::exists(run_folder_.record()));
}

TEST_F(RunTest, TellsNorthThroughTheReference) {
  add_reference(0);
  run_all();
  EXPECT_TRUE(record()["map"]["north"].is_null());
  // A reference that is turned by a quarter against the estimate.
  geometry::Pose3 T_reference_map;
  T_reference_map.rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  source_.reference_->T_map_body = source_.reference_->T_map_body.transformed_left(T_reference_map);
  source_.reference_->north_map = Eigen::Vector3d::UnitY();
  run_again();
  EXPECT_NEAR(record()["map"]["north"][0].get<double>(), 1, 1e-6);
  EXPECT_NEAR(record()["map"]["north"][1].get<double>(), 0, 1e-6);
}

TEST_F(RunTest, ChecksTheJacobiansOfTheFactorsThatTheEstimatorUses) {
  estimator_->uses = {{"plane absolute", optimization::Perturbation::kLeft}};
  run_all();
  const auto audit =
      optimization::audit_from_json(files::JsonDocument::read(run_folder_.jacobians()).root());
  ASSERT_EQ(audit.factors.size(), 1U);
  EXPECT_EQ(audit.factors[0].factor, "plane absolute");
  EXPECT_EQ(audit.factors[0].perturbation, optimization::Perturbation::kLeft);
  EXPECT_TRUE(audit.passed());
}

TEST_F(RunTest, TakesTheFramesAskedForAndNumbersThemAsInTheRecording) {
  RunOptions options;
  options.first = 5;
  options.last = 9;
  run_all(options);
  EXPECT_THAT(FrameTable::read_csv(run_folder_.frames()).column("frame"),
              ElementsAre(5, 6, 7, 8, 9));
  EXPECT_EQ(record()["frames"]["first"], 5);
}

TEST_F(RunTest, HeldBackFramesOfAShortRecordingAreNotLost) {
  RunOptions options;
  options.last = 1;
  EXPECT_EQ(run_all(options).frames_used, 2U);
}

TEST_F(RunTest, AStopEndsInOrderWithWhatIsDone) {
  std::atomic<bool> stop{false};
  RunObserver observer;
  observer.stop = &stop;
  observer.frame = [&](std::size_t done) { stop = done >= 8; };
  const RunRecord result = run_all({}, observer);
  EXPECT_EQ(result.status, RunStatus::kInterrupted);
  EXPECT_EQ(result.frames_used, 8U);
  EXPECT_EQ(record()["status"], "interrupted");
  EXPECT_TRUE(std::filesystem::exists(run_folder_.trajectory()));
}

TEST_F(RunTest, AStopBeforeTheFirstFrameIsNoFailureOfTheRun) {
  const std::atomic<bool> stop{true};
  RunObserver observer;
  observer.stop = &stop;
  EXPECT_EQ(run_all({}, observer).frames_used, 0U);
  EXPECT_EQ(record()["status"], "interrupted");
  EXPECT_THAT(std::string(record()["reason"]), ::testing::HasSubstr("stopped by the user"));
}

TEST_F(RunTest, AnEstimatorThatFailsLeavesWhatItEstimatedBefore) {
  add_reference(0);
  estimator_->fail_at = geometry::Stamp::from_seconds(1);
  const RunRecord result = run_all();
  EXPECT_EQ(result.status, RunStatus::kFailed);
  EXPECT_EQ(result.frames_used, 10U);
  EXPECT_EQ(record()["status"], "failed");
  EXPECT_EQ(record()["reason"], "cannot go on");
  expect_results_of(10);
}

TEST_F(RunTest, ARecordingThatCannotBeReadOnLeavesWhatWasEstimatedBefore) {
  add_reference(0);
  source_.fail_at_ = 7;
  EXPECT_EQ(run_all().status, RunStatus::kFailed);
  EXPECT_THAT(std::string(record()["reason"]), HasSubstr("damaged"));
  expect_results_of(7);
}

TEST_F(RunTest, FramesThatWereHeldBackWhenReadingFailedAreNotLost) {
  source_.fail_at_ = 2;
  EXPECT_EQ(run_all().frames_used, 2U);
  expect_results_of(2);
}

TEST_F(RunTest, MemoryThatRanOutIsSaidInWords) {
  estimator_->out_of_memory_at = geometry::Stamp::from_seconds(1);
  EXPECT_EQ(run_all().status, RunStatus::kFailed);
  EXPECT_THAT(std::string(record()["reason"]), HasSubstr("out of memory"));
  expect_results_of(10);
}

TEST_F(RunTest, NoFrameInTheRangeIsAFailure) {
  RunOptions options;
  options.first = 50;
  EXPECT_EQ(run_all(options).status, RunStatus::kFailed);
  EXPECT_THAT(std::string(record()["reason"]), HasSubstr("no usable scan"));
}

TEST_F(RunTest, WritesIntoNoFolderThatHoldsSomething) {
  files::make_writable_folder(run_folder_.path);
  files::write_text(run_folder_.map_points(), "mine");
  EXPECT_THROW(run_all(), files::OutputError);
  EXPECT_EQ(files::read_text(run_folder_.map_points()), "mine");
}

TEST_F(RunTest, AReferenceThatDoesNotOverlapIsToldAndTheRestIsWritten) {
  add_reference(1000);
  const RunRecord result = run_all();
  EXPECT_EQ(result.status, RunStatus::kOk);
  EXPECT_FALSE(result.evaluation_error.empty());
  EXPECT_EQ(record()["evaluation_error"], result.evaluation_error);
  const auto evaluation = evaluation::from_json(files::read_text(run_folder_.evaluation()));
  EXPECT_FALSE(evaluation.comparison);
  EXPECT_TRUE(std::filesystem::exists(run_folder_.map_points()));
}

TEST_F(RunTest, SkippedRecordsReachTheRecord) {
  source_.skipped_.add("empty scan", "velodyne/000003.bin");
  run_all();
  EXPECT_EQ(record()["frames"]["skipped"]["empty scan"], 1);
  EXPECT_EQ(record()["frames"]["read"], 21);
}

TEST_F(RunTest, AFullDiskIsAnErrorAndNoFileIsHalfWritten) {
  {
    const testing::FileSizeLimit limit(600);  // neither map.ply nor run.json fit
    EXPECT_THROW(run_all(), files::OutputError);
  }
  for (const auto& entry : std::filesystem::directory_iterator(run_folder_.path)) {
    EXPECT_EQ(entry.path().string().find(".partial"), std::string::npos) << entry.path();
  }
  EXPECT_TRUE(std::filesystem::exists(run_folder_.trajectory()));
  EXPECT_FALSE(std::filesystem::exists(run_folder_.map_points()));
  EXPECT_FALSE(std::filesystem::exists(run_folder_.record()));
}

TEST_F(RunTest, TheSampleScanIsFromTheSecondHalf) {
  run_all();
  EXPECT_EQ(record()["frames"]["sample"], 16);
  const auto cloud = dataset::read_point_cloud(run_folder_.sample_scan());
  EXPECT_EQ(cloud.size(), 50U);
  EXPECT_NE(cloud.find("feature_class"), nullptr);
}

}  // namespace
}  // namespace traverse::pipeline
