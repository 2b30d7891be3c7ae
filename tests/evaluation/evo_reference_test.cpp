#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/evaluation/evaluate.hpp"

#include "test_data.hpp"

namespace traverse::evaluation {
namespace {

/// One line as it was given to evo: "evo_rpe kitti REF EST -d 20 -u m --all_pairs -r angle_deg".
struct EvoCommand {
  bool relative = false;
  std::string reference;
  std::string estimate;
  AlignmentOptions alignment;
  Relation relation = Relation::kTranslation;
  RpeOptions rpe;
};

Relation evo_relation(const std::string& word) {
  if (word == "trans_part") return Relation::kTranslation;
  if (word == "rot_part") return Relation::kRotation;
  if (word == "full") return Relation::kFull;
  if (word == "angle_rad") return Relation::kAngleRad;
  if (word == "angle_deg") return Relation::kAngleDeg;
  if (word == "point_distance") return Relation::kPointDistance;
  if (word == "point_distance_error_ratio") return Relation::kPointDistanceRatio;
  throw std::invalid_argument("relation " + word);
}

DeltaUnit evo_unit(const std::string& word) {
  if (word == "f") return DeltaUnit::kFrames;
  if (word == "m") return DeltaUnit::kMetres;
  if (word == "d") return DeltaUnit::kDegrees;
  if (word == "r") return DeltaUnit::kRadians;
  throw std::invalid_argument("unit " + word);
}

EvoCommand parse(const std::string& command) {
  std::istringstream words(command);
  EvoCommand parsed;
  std::string program, format, word;
  words >> program >> format >> parsed.reference >> parsed.estimate;
  if (format != "kitti") throw std::invalid_argument("format " + format);
  parsed.relative = program == "evo_rpe";
  while (words >> word) {
    if (word == "-a") {
      parsed.alignment.mode = AlignmentMode::kSe3;
    } else if (word == "-as") {
      parsed.alignment.mode = AlignmentMode::kSim3;
    } else if (word == "-s") {
      parsed.alignment.mode = AlignmentMode::kScale;
    } else if (word == "--align_origin") {
      parsed.alignment.mode = AlignmentMode::kOrigin;
    } else if (word == "--n_to_align") {
      words >> word;
      parsed.alignment.first = std::stoul(word);
    } else if (word == "-r") {
      words >> word;
      parsed.relation = evo_relation(word);
    } else if (word == "-d") {
      words >> parsed.rpe.delta.value;
    } else if (word == "-u") {
      words >> word;
      parsed.rpe.delta.unit = evo_unit(word);
    } else if (word == "--all_pairs") {
      parsed.rpe.all_pairs = true;
    } else if (word == "--pairs_from_reference") {
      parsed.rpe.pairs_from = PairsFrom::kReference;
    } else {
      throw std::invalid_argument("option " + word);
    }
  }
  return parsed;
}

Statistics run(const EvoCommand& command, const std::filesystem::path& folder) {
  const auto kitti = dataset::TrajectoryFormat::kKitti;
  const auto reference = dataset::read_trajectory(folder / command.reference, kitti);
  const auto estimate = dataset::read_trajectory(folder / command.estimate, kitti);
  EvaluationOptions options;
  options.alignment = command.alignment;
  options.ape_relations.clear();
  options.rpe_relations = {command.relation};
  if (command.relative) {
    options.rpe = {command.rpe};
  } else {
    options.ape_relations = {command.relation};
  }
  const Comparison comparison = *evaluate(estimate, reference, options).comparison;
  return command.relative ? comparison.rpe.at(0).statistics : comparison.ape.at(0).statistics;
}

void expect_near(double found, double known, const char* name) {
  EXPECT_NEAR(found, known, 1e-9 * std::max(1.0, std::abs(known))) << name;
}

TEST(EvoReference, EveryRecordedCaseAgrees) {
  const auto folder = testing::test_data() / "trajectories";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no trajectories in " << folder;
  const auto recorded = nlohmann::json::parse(std::ifstream(folder / "evo_reference.json"));
  ASSERT_EQ(recorded.at("cases").size(), 85U);
  for (const auto& item : recorded.at("cases")) {
    const auto text = item.at("command").get<std::string>();
    SCOPED_TRACE(text);
    const Statistics found = run(parse(text), folder);
    const auto& known = item.at("stats");
    EXPECT_EQ(found.count, item.at("n").get<std::size_t>());
    expect_near(found.rmse, known.at("rmse"), "rmse");
    expect_near(found.mean, known.at("mean"), "mean");
    expect_near(found.median, known.at("median"), "median");
    expect_near(found.std, known.at("std"), "std");
    expect_near(found.min, known.at("min"), "min");
    expect_near(found.max, known.at("max"), "max");
    expect_near(found.sse, known.at("sse"), "sse");
  }
}

}  // namespace
}  // namespace traverse::evaluation
