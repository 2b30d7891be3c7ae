#include "traverse/pipeline/odometry_kind.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/json_document.hpp"
#include "traverse/optimization/jacobian_audit.hpp"
#include "traverse/pipeline/factor_kinds.hpp"
#include "traverse/pipeline/frame_table.hpp"
#include "traverse/pipeline/registry.hpp"
#include "traverse/pipeline/run.hpp"

#include "pipeline/made_source.hpp"
#include "temporary_folder.hpp"

namespace traverse::pipeline {
namespace {

using ::testing::HasSubstr;
using testing::MadeSource;
using testing::TemporaryFolder;

struct CreepingOptions {
  double step_m = 0.1;
  int threads = 0;
};

void bind(config::Binder& binder, CreepingOptions& options) {
  binder.number("step_m", options.step_m, config::Range::between(0, 1), "ahead with each scan");
}

/// An odometry of somebody else, that finds each scan a step ahead of the one before.
class CreepingOdometry final : public lidar::Odometry {
 public:
  CreepingOdometry(const CreepingOptions& options, const sensors::LidarProfile& profile,
                   bool motion_compensated)
      : options_(options), profile_(profile), note_(motion_compensated ? "off" : "on") {}

  std::vector<lidar::Frame> process(const sensors::LidarScan& scan) override {
    lidar::Frame frame;
    frame.index = frames_;
    frame.stamp = scan.stamp;
    frame.health.registered = frames_ > 0;
    frame.T_map_lidar.translation.x() = options_.step_m * static_cast<double>(frames_++);
    frame.health.iterations = options_.threads;  // to be seen in the record
    return {frame};
  }
  std::vector<lidar::Frame> finish() override { return {}; }
  const std::string& deskew_note() const override { return note_; }
  std::vector<optimization::FactorUse> factors() const override {
    return {{"factor of somebody else"}};
  }
  lidar::CorrectedScan used_scan(const sensors::LidarScan& scan, const geometry::Twist& velocity,
                                 bool) const override {
    return lidar::corrected(scan, profile_, velocity);
  }
  std::unique_ptr<lidar::Odometry> clone() const override {
    return std::make_unique<CreepingOdometry>(*this);
  }
  std::size_t bytes() const override { return 0; }

 private:
  CreepingOptions options_;
  sensors::LidarProfile profile_;
  std::string note_;
  std::size_t frames_ = 0;
};

/// One of Traverse's under another name.
optimization::FactorKind factor_of_somebody_else() {
  optimization::FactorKind kind = factor_kinds().front();
  kind.name = "factor of somebody else";
  return kind;
}

class OwnOdometry : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    register_odometry("creeping", odometry_kind<CreepingOdometry, CreepingOptions>());
    register_factor_kinds({factor_of_somebody_else()});
  }

  Preset preset(const std::string& settings) {
    files::write_text(folder_ / "mine.yaml", "estimator: creeping\n" + settings);
    return load_preset({(folder_ / "mine.yaml").string(), {}, {}}, TRAVERSE_SHARE_DIR);
  }

  MadeSource recording() {
    files::write_text(folder_ / "data", "abc");
    dataset::RecordingInfo info;
    info.path = folder_ / "data";
    sensors::MountedSensor lidar;
    lidar.label = "lidar";
    lidar.lidar = sensors::LidarProfile{};
    info.rig.sensors.push_back(lidar);
    std::vector<sensors::Measurement> scans;
    for (int i = 0; i < 5; ++i) {
      auto scan = std::make_shared<sensors::LidarScan>();
      scan->stamp = geometry::Stamp::from_seconds(0.1 * i);
      scan->sensor = "lidar";
      scan->x = scan->y = scan->z = {3, 4, 5, 6};
      scan->ring = {0, 0, 1, 1};
      scans.emplace_back(std::shared_ptr<const sensors::LidarScan>(scan));
    }
    return MadeSource(info, scans);
  }

  TemporaryFolder folder_;
};

TEST_F(OwnOdometry, HasItsSettingsAndThoseOfLoops) {
  const auto settings = resolve_settings(preset("step_m: 0.3\nslam: {use: false}\n"));
  const auto value = [&](const std::string& key) {
    const auto found = std::find_if(settings.begin(), settings.end(),
                                    [&](const auto& s) { return s.setting.path == key; });
    return found == settings.end() ? "none" : config::to_text(found->setting.value);
  };
  EXPECT_EQ(value("step_m"), "0.3");
  EXPECT_EQ(value("slam.use"), "false");
  try {
    resolve_settings(preset("step_m: 2\n"));
    FAIL() << "a step of 2 m is out of range";
  } catch (const files::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("mine.yaml"));
    EXPECT_THAT(error.what(), HasSubstr("step_m"));
  }
}

TEST_F(OwnOdometry, IsNamedAmongTheEstimatorsAndOnlyOnce) {
  files::write_text(folder_ / "none.yaml", "estimator: nobody's\n");
  try {
    resolve_settings(load_preset({(folder_ / "none.yaml").string(), {}, {}}, TRAVERSE_SHARE_DIR));
    FAIL() << "there is no such estimator";
  } catch (const files::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("creeping, "));
  }
  EXPECT_THROW(register_odometry("creeping", odometry_kind<CreepingOdometry, CreepingOptions>()),
               std::invalid_argument);
  EXPECT_THROW(register_odometry("voxel_map", odometry_kind<CreepingOdometry, CreepingOptions>()),
               std::invalid_argument);
}

TEST_F(OwnOdometry, GoesThroughARunWithItsFactors) {
  MadeSource source = recording();
  Pipeline pipeline = make_pipeline(preset("step_m: 0.3\n"), source.info(), 2);
  const RunFolder folder{folder_ / "run"};
  RunOptions options;
  options.hash_recording = false;
  EXPECT_EQ(run(source, pipeline, folder, options, {}).status, RunStatus::kOk);
  const FrameTable frames = FrameTable::read_csv(folder.frames());
  EXPECT_EQ(frames.rows().size(), 5U);
  EXPECT_EQ(frames.column("solver_iterations").at(0), 2) << "the threads that it was given";
  const auto audit =
      optimization::audit_from_json(files::JsonDocument::read(folder.jacobians()).root());
  ASSERT_FALSE(audit.factors.empty());
  EXPECT_EQ(audit.factors[0].factor, "factor of somebody else");
}

TEST_F(OwnOdometry, FactorsOfOneNameAreRefused) {
  EXPECT_THROW(register_factor_kinds({factor_of_somebody_else()}), std::invalid_argument);
  EXPECT_THROW(register_factor_kinds({factor_kinds().front()}), std::invalid_argument);
}

}  // namespace
}  // namespace traverse::pipeline
