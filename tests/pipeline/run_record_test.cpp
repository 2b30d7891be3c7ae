#include "traverse/pipeline/run_record.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "traverse/pipeline/frame_table.hpp"

namespace traverse::pipeline {
namespace {

using nlohmann::json;

RunRecord made_record() {
  RunRecord record;
  record.status = RunStatus::kOk;
  record.pipeline = "floam";
  record.command = {"traverse", "run", "a b"};
  record.settings.push_back({{"solver.huber_m", 0.2, "residuals beyond", "above 0"}, 0.1});
  record.recording.name = "drive \xff <script>";  // names from files need not be valid text
  record.recording.facts.push_back({"motion compensated", "no", "stated"});
  record.skipped.add("empty scan", "velodyne/000003.bin");
  record.skipped.add("empty scan", "velodyne/000004.bin");
  return record;
}

json as_json(const RunRecord& record) {
  return json::parse(to_json(record, build_info(), host_info()));
}

TEST(RunRecord, HoldsWhatTheContractPromises) {
  const json record = as_json(made_record());
  EXPECT_EQ(record["status"], "ok");
  EXPECT_EQ(record["frames"]["skipped"]["empty scan"], 2);
  EXPECT_EQ(record["skipped_records"]["empty scan"]["first"][1], "velodyne/000004.bin");
  EXPECT_EQ(record["configuration"]["settings"][0]["changed"], true);
  EXPECT_EQ(record["configuration"]["settings"][0]["preset"], 0.1);
  EXPECT_EQ(record["recording"]["facts"][0]["reason"], "stated");
  EXPECT_EQ(record["command"][2], "a b");
  EXPECT_TRUE(record["reference"].is_null());
  EXPECT_TRUE(record["recording"]["sha256"].is_null());
  for (const char* key : {"timing_ms", "threads", "body_frame", "program", "host", "started_utc",
                          "wall_seconds", "peak_memory_mb", "map", "decisions"}) {
    EXPECT_TRUE(record.contains(key)) << key;
  }
}

TEST(RunRecord, ConfigurationDigestTellsConfigurationsApart) {
  RunRecord record = made_record();
  const std::string digest = configuration_sha256(record.settings);
  EXPECT_EQ(digest, configuration_sha256(made_record().settings));
  record.settings[0].setting.value = 0.3;
  EXPECT_NE(digest, configuration_sha256(record.settings));
}

TEST(RunRecord, SummarisesTheTimesOfTheStages) {
  FrameTable frames({"frame", "solve_ms", "total_ms"});
  for (int i = 1; i <= 101; ++i) frames.add_row({0, 1.0 * i, 2.0 * i});
  RunRecord record;
  summarise_timing(frames, record);
  EXPECT_EQ(record.frame_median_ms, 102);
  EXPECT_EQ(record.frame_p95_ms, 192);
  EXPECT_EQ(record.frame_max_ms, 202);
  EXPECT_EQ(record.frames_total_ms, 101 * 102);
  ASSERT_EQ(record.stages.size(), 1U);
  EXPECT_EQ(record.stages[0].name, "solve");
  EXPECT_EQ(record.stages[0].median, 51);
}

TEST(RunRecord, WithoutFramesThereAreNoTimes) {
  RunRecord record;
  summarise_timing(FrameTable({"total_ms"}), record);
  EXPECT_EQ(record.frame_median_ms, 0);
}

}  // namespace
}  // namespace traverse::pipeline
