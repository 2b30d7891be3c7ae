#include "traverse/batch/metric.hpp"

#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"

#include "temporary_folder.hpp"

namespace traverse::batch {
namespace {

using testing::TemporaryFolder;

TEST(Metric, EachHasANameOfItsOwnAndTheDefaultsAreKnown) {
  std::set<std::string> keys;
  for (const Metric& metric : known_metrics()) EXPECT_TRUE(keys.insert(metric.key).second);
  for (const std::string& key : default_metrics()) EXPECT_NE(find_metric(key), nullptr) << key;
  EXPECT_EQ(find_metric("ape_translation_rmse")->title, "APE");
  EXPECT_EQ(find_metric("rpe_10f_angle_deg_max")->title, "RPE 10 frames angle max");
  EXPECT_EQ(find_metric("rpe_100m_translation_rmse")->unit, "m");
  EXPECT_EQ(find_metric("ape"), nullptr);
}

TEST(Metric, AreReadFromARunFolder) {
  const TemporaryFolder run;
  files::write_text(run / "evaluation.json", R"({
    "ape": {"translation": {"rmse": 0.1, "max": 0.3, "per_pair": {"value": [1, 2]}},
            "angle-deg": {"rmse": 0.5}},
    "rpe": [{"delta": 10, "unit": "f", "relation": "translation", "stats": {"rmse": 0.2}},
            {"delta": 100.0, "unit": "m", "relation": "angle-deg", "stats": {"mean": 0.4}}],
    "kitti": {"translation_percent": 1.2, "rotation_deg_per_m": 0.01, "segments": 7},
    "path": {"end_error_percent": null}, "consistency": {"mme": -1.5}})");
  files::write_text(run / "run.json", R"({"frames": {"used": 5, "skipped": {"empty": 2, "cut": 1}},
    "timing_ms": {"frame_median": 12.5, "total": 60}})");
  const auto values = read_metrics(run.path());
  const std::map<std::string, double> expected{{"ape_translation_rmse", 0.1},
                                               {"ape_translation_max", 0.3},
                                               {"ape_angle_deg_rmse", 0.5},
                                               {"rpe_10f_translation_rmse", 0.2},
                                               {"rpe_100m_angle_deg_mean", 0.4},
                                               {"kitti_translation_percent", 1.2},
                                               {"kitti_rotation_deg_per_m", 0.01},
                                               {"kitti_segments", 7},
                                               {"mme", -1.5},
                                               {"frames_used", 5},
                                               {"frames_skipped", 3},
                                               {"frame_median_ms", 12.5},
                                               {"frames_total_ms", 60}};
  EXPECT_EQ((std::map<std::string, double>(values.begin(), values.end())), expected);
}

TEST(Metric, LoopsAndDegenerateFramesAreCounted) {
  const TemporaryFolder run;
  files::write_text(run / "evaluation.json", R"({"consistency": {"mme": -2, "queries": 7}})");
  files::write_text(run / "odometry_evaluation.json",
                    R"({"ape": {"translation": {"rmse": 0.5}}, "consistency": {"mme": -1}})");
  files::write_text(run / "loops.csv", "keyframe,verdict\n3,accepted\n5,residual\n6,accepted\n");
  files::write_text(run / "frames.csv", "frame,degenerate_directions\n0,0\n1,2\n2,1\n");
  const auto values = read_metrics(run.path());
  const std::map<std::string, double> expected{{"mme", -2},
                                               {"mme_queries", 7},
                                               {"odometry_ape_translation_rmse", 0.5},
                                               {"odometry_mme", -1},
                                               {"loop_candidates", 3},
                                               {"loops_accepted", 2},
                                               {"degenerate_frames", 2}};
  EXPECT_EQ((std::map<std::string, double>(values.begin(), values.end())), expected);
}

TEST(Metric, ACrashedRunHasWhatItWroteAndNoMore) {
  const TemporaryFolder run;
  EXPECT_TRUE(read_metrics(run.path()).empty());
  files::write_text(run / "run.json", "{\"frames\": {\"us");
  EXPECT_TRUE(read_metrics(run.path()).empty());
  files::write_text(run / "evaluation.json", "{\"ape\": [1, 2], \"rpe\": 3}");
  EXPECT_TRUE(read_metrics(run.path()).empty());
}

}  // namespace
}  // namespace traverse::batch
