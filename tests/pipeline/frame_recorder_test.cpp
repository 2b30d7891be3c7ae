#include "frame_recorder.hpp"

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "temporary_folder.hpp"

namespace traverse::pipeline {
namespace {

using testing::TemporaryFolder;

/// Registers on one line and one plane, each point as far off as the frame's residual.
class MatchingEstimator : public Estimator {
 public:
  explicit MatchingEstimator(std::vector<std::string> columns) : columns_(std::move(columns)) {}
  const std::vector<std::string>& columns() const override { return columns_; }
  std::vector<PoseFrame> process(const sensors::Measurement&) override { return {}; }
  std::vector<PoseFrame> finish() override { return {}; }
  UsedScan used_scan(const sensors::LidarScan&, const PoseFrame&, bool) const override {
    return {};
  }
  std::string points_are() const override { return "as made"; }
  std::vector<Decision> decisions() const override { return {}; }
  std::unique_ptr<Estimator> clone() const override {
    return std::make_unique<MatchingEstimator>(*this);
  }
  std::vector<MatchedPoint> matches() const override {
    ++asked;
    return {{true, {1, 2, 3 + residual}, {1, 2, 3}, {1, 0, 0}, residual},
            {false, {4, 5, 6 - residual}, {4, 5, 6}, {0, 0, 1}, -residual}};
  }

  double residual = 0;
  mutable int asked = 0;

 private:
  std::vector<std::string> columns_;
};

UsedScan scan_of(std::size_t points) {
  UsedScan used;
  for (std::size_t i = 0; i < points; ++i) {
    used.x.push_back(static_cast<float>(i));
    used.y.push_back(0);
    used.z.push_back(1);
  }
  return used;
}

/// Frames with these residuals, each one metre further.
void add_frames(const std::vector<double>& residuals, std::size_t points,
                MatchingEstimator& estimator, FrameRecorder& recorder) {
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    PoseFrame frame;
    frame.T_map_body.translation = {static_cast<double>(i), 0, 0};
    frame.record = {7, residuals[i]};
    estimator.residual = residuals[i];
    if (recorder.wants(i, frame)) recorder.add(i, frame, scan_of(points));
  }
}

/// As many final poses: those of add_frames, ten metres to the left.
geometry::Trajectory final_poses(std::size_t count) {
  geometry::Trajectory poses;
  for (std::size_t i = 0; i < count; ++i) {
    geometry::Pose3 T_map_body;
    T_map_body.translation = {static_cast<double>(i), 10, 0};
    poses.push_back(geometry::Stamp::from_seconds(static_cast<double>(i)), T_map_body);
  }
  return poses;
}

std::vector<float> floats(const dataset::PointCloud& cloud, const char* field) {
  return dataset::to_floats(*cloud.find(field));
}

TEST(FrameRecorder, GivesBackTheFrameOfASegmentWithTheLargestResiduals) {
  const TemporaryFolder folder;
  MatchingEstimator estimator({"points", "residual_rms_m"});
  FrameRecorder recorder(folder.path(), estimator);
  std::vector<double> residuals(20, 0.125);
  residuals[7] = 0.5;
  residuals[9] = 0.25;
  add_frames(residuals, 3, estimator, recorder);
  EXPECT_LT(estimator.asked, 10) << "matches are asked for only where they may be kept";

  const dataset::PointCloud cloud =
      recorder.worst_frames({"", "m", {{3, 13, 1}}}, final_poses(20), 100);
  ASSERT_EQ(cloud.size(), 5U);
  EXPECT_EQ(floats(cloud, "frame"), std::vector<float>(5, 107));
  EXPECT_EQ(floats(cloud, "kind"), (std::vector<float>{0, 0, 0, 1, 2}));
  EXPECT_EQ(floats(cloud, "x"), (std::vector<float>{7, 8, 9, 1, 4}));
  EXPECT_EQ(floats(cloud, "y"), (std::vector<float>{10, 10, 10, 12, 15}));
  EXPECT_EQ(floats(cloud, "z"), (std::vector<float>{1, 1, 1, 3.5F, 5.5F}));
  EXPECT_EQ(floats(cloud, "offset_z"), (std::vector<float>{0, 0, 0, 0.5F, -0.5F}));
  EXPECT_EQ(floats(cloud, "residual_m"), (std::vector<float>{0, 0, 0, 0.5F, -0.5F}));
}

TEST(FrameRecorder, HasAFrameOfEverySegmentOfTen) {
  const TemporaryFolder folder;
  MatchingEstimator estimator({"points", "residual_rms_m"});
  FrameRecorder recorder(folder.path(), estimator);
  // The residuals grow towards the middle, so that neighbours outside a segment are the worse ones.
  std::vector<double> residuals;
  for (int i = 0; i < 41; ++i) residuals.push_back(1 - 0.02 * std::abs(i - 20));
  add_frames(residuals, 1, estimator, recorder);
  for (std::size_t first = 0; first + 10 < residuals.size(); ++first) {
    const auto cloud =
        recorder.worst_frames({"", "m", {{first, first + 10, 1}}}, final_poses(41), 0);
    ASSERT_EQ(cloud.size(), 3U) << first;
    EXPECT_GT(floats(cloud, "frame")[0], first);
    EXPECT_LE(floats(cloud, "frame")[0], first + 10);
  }
}

TEST(FrameRecorder, ThinsWhatIsLargeAndKeepsNothingWithoutARegistration) {
  const TemporaryFolder folder;
  MatchingEstimator estimator({"points", "residual_rms_m"});
  FrameRecorder recorder(folder.path(), estimator);
  add_frames(std::vector<double>(11, 0.1), 100'000, estimator, recorder);
  const auto cloud = recorder.worst_frames({"", "m", {{0, 10, 1}}}, final_poses(11), 0);
  EXPECT_LT(cloud.size(), 10'000U);
  EXPECT_GT(floats(cloud, "x")[cloud.size() - 3], 90'000) << "spread over the whole scan";

  MatchingEstimator other({"points", "speed"});
  FrameRecorder none(folder.path(), other);
  add_frames(std::vector<double>(11, 0.1), 10, other, none);
  EXPECT_EQ(none.worst_frames({"", "m", {{0, 10, 1}}}, final_poses(11), 0).size(), 0U);
}

}  // namespace
}  // namespace traverse::pipeline
