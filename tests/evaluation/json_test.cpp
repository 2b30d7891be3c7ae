#include "traverse/evaluation/json.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "evaluation/golden_trajectories.hpp"
#include "geometry/random_motion.hpp"

namespace traverse::evaluation {
namespace {

using Json = nlohmann::json;

Evaluation golden_evaluation() {
  EvaluationOptions options = run_evaluation_options();
  options.rpe.push_back({{5, DeltaUnit::kDegrees}, false, PairsFrom::kReference});
  Evaluation evaluation =
      evaluate(testing::golden_estimate(), testing::golden_reference(), options);
  evaluation.estimate.name = "a \"b\"\\ü.tum";
  evaluation.comparison->kitti->T_body_camera = testing::golden_reference_pose(17);
  evaluation.comparison->undefined.push_back({"RPE, 1 m", "a reason"});
  evaluation.consistency =
      Consistency{-1.0 / 3, 0.1, 79125, PointToPlane{5, 0.1, 0.2, 0.3}, 108, 3152088, "raw"};
  return evaluation;
}

std::string message_of(const std::string& text) {
  try {
    from_json(text);
  } catch (const EvaluationError& error) {
    return error.what();
  }
  return "no error";
}

/// The file with one value replaced, by its JSON pointer.
std::string with(const std::string& pointer, const Json& value) {
  Json json = Json::parse(to_json(golden_evaluation()));
  json.at(Json::json_pointer(pointer)) = value;
  return json.dump();
}

TEST(EvaluationJson, HasTheKeysThatScriptsRelyOn) {
  const Json json = Json::parse(to_json(golden_evaluation()));
  EXPECT_EQ(json.at("association").at("pairs"), 514);
  EXPECT_EQ(json.at("association").at("max_time_difference"), 0.01);
  EXPECT_EQ(json.at("alignment").at("mode"), "se3");
  EXPECT_EQ(json.at("alignment").at("scale"), 1);
  EXPECT_EQ(json.at("alignment").at("T_reference_estimate").at(3), Json({0, 0, 0, 1}));
  for (const char* key : {"rmse", "mean", "median", "std", "min", "max", "sse", "count"}) {
    EXPECT_TRUE(json.at("ape").at("angle-deg").at(key).is_number()) << key;
    EXPECT_TRUE(json.at("rpe").at(0).at("stats").at(key).is_number()) << key;
  }
  EXPECT_EQ(json.at("ape").size(), 6U);
  EXPECT_NEAR(json.at("ape").at("translation").at("rmse"), 2.008707081862, 1e-9);
  const Json& rpe = json.at("rpe").at(0);
  EXPECT_EQ(rpe.at("delta"), 1);
  EXPECT_EQ(rpe.at("unit"), "f");
  EXPECT_EQ(rpe.at("all_pairs"), true);
  EXPECT_EQ(rpe.at("pairs_from"), "estimate");
  EXPECT_EQ(rpe.at("relation"), "translation");
  EXPECT_EQ(json.at("kitti").at("frame"), "body");
  EXPECT_EQ(json.at("kitti").at("segments"), 131);
  EXPECT_EQ(json.at("kitti").at("by_length").at(0).at("length_m"), 100);
  for (const char* key :
       {"estimate_m", "reference_m", "end_error_m", "end_error_percent", "end_rotation_deg"}) {
    EXPECT_TRUE(json.at("path").at(key).is_number()) << key;
  }
  EXPECT_EQ(json.at("consistency").at("queries"), 79125);
}

TEST(EvaluationJson, HoldsTheValuesBehindEachFigure) {
  const Evaluation evaluation = golden_evaluation();
  const Json json = Json::parse(to_json(evaluation));
  const Json& pairs = json.at("association").at("per_pair");
  EXPECT_EQ(pairs.at("stamp_ns").at(100), evaluation.comparison->stamps[100].nanoseconds);
  EXPECT_EQ(pairs.at("distance_m").at(100), evaluation.comparison->distances_m[100]);
  EXPECT_EQ(json.at("ape").at("full").at("per_pair").at("value").size(), 514U);
  EXPECT_EQ(json.at("rpe").at(0).at("per_pair").at("to").at(7), 8);
  EXPECT_EQ(json.at("kitti").at("per_segment").at("speed_mps").size(), 131U);
}

TEST(EvaluationJson, ReadsBackToTheSameBits) {
  const Evaluation evaluation = golden_evaluation();
  const std::string text = to_json(evaluation);
  const Evaluation back = from_json(text);
  EXPECT_EQ(to_json(back), text);
  EXPECT_EQ(back.estimate.name, evaluation.estimate.name);
  EXPECT_EQ(back.comparison->ape[2].values, evaluation.comparison->ape[2].values);
  EXPECT_EQ(back.comparison->rpe[3].pairs, evaluation.comparison->rpe[3].pairs);
  EXPECT_EQ(back.comparison->stamps, evaluation.comparison->stamps);
  EXPECT_EQ(back.comparison->alignment.T_reference_estimate.matrix(),
            evaluation.comparison->alignment.T_reference_estimate.matrix());
}

TEST(EvaluationJson, NumbersOfEverySizeReadBackToTheSameBits) {
  testing::RandomMotion random(1);
  Evaluation evaluation = golden_evaluation();
  std::vector<double>& values = evaluation.comparison->ape[0].values;
  for (double& value : values)
    value = random.uniform(-1, 1) * std::pow(10, random.uniform(-300, 300));
  values[0] = 5e-324;
  values[1] = std::numeric_limits<double>::max();
  values[2] = -0.0;
  EXPECT_EQ(from_json(to_json(evaluation)).comparison->ape[0].values, values);
}

TEST(EvaluationJson, WithoutReferenceThereIsNullNotNothing) {
  Evaluation evaluation = evaluate(testing::golden_estimate());
  const std::string text = to_json(evaluation);
  const Json json = Json::parse(text);
  for (const char* key : {"reference", "association", "alignment", "kitti", "consistency"}) {
    EXPECT_TRUE(json.at(key).is_null()) << key;
  }
  EXPECT_TRUE(json.at("ape").empty());
  EXPECT_TRUE(json.at("path").at("reference_m").is_null());
  EXPECT_TRUE(json.at("path").at("estimate_m").is_number());
  EXPECT_FALSE(from_json(text).comparison);
  EXPECT_EQ(to_json(from_json(text)), text);
}

TEST(EvaluationJson, WithoutStampsAndDriftToo) {
  const auto poses = geometry::Trajectory::unstamped({geometry::Pose3(), geometry::Pose3()});
  const std::string text = to_json(evaluate(poses, poses, {}));
  EXPECT_TRUE(Json::parse(text).at("association").at("per_pair").at("stamp_ns").is_null());
  EXPECT_TRUE(Json::parse(text).at("path").at("end_error_percent").is_null());
  EXPECT_TRUE(Json::parse(text).at("kitti").is_null());
  EXPECT_EQ(to_json(from_json(text)), text);
}

TEST(EvaluationJson, NamesWhatIsWrong) {
  EXPECT_EQ(message_of(""), "not an evaluation, line 1: expected JSON, found its end");
  EXPECT_EQ(message_of("{}"), "not an evaluation, key estimate: expected a value, found none");
  EXPECT_EQ(message_of("[1]"), "not an evaluation, key estimate: expected a value, found none");
  EXPECT_EQ(message_of(with("/ape/full/rmse", "x")),
            "not an evaluation, key ape.full.rmse: expected a number, found \"x\"");
  EXPECT_EQ(message_of(with("/estimate/poses", -3)),
            "not an evaluation, key estimate.poses: expected a count, found -3");
  EXPECT_EQ(message_of(with("/ape/full/per_pair/value", {1, 2})),
            "not an evaluation, key ape.full.per_pair.value: expected a list of 514, found a list "
            "of 2");
  EXPECT_EQ(message_of(with("/rpe/0/per_pair/to/4", 514)),
            "not an evaluation, key rpe.0.per_pair.to: expected indices of 514 pairs, found 514");
  EXPECT_EQ(message_of(with("/association/per_pair/distance_m/3", 1e300)),
            "not an evaluation, key association.per_pair.distance_m: expected distances from 0 "
            "on that never shrink, found a list of 514");
  EXPECT_EQ(message_of(with("/rpe/0/relation", "speed")),
            "not an evaluation, key rpe.0.relation: expected a known name, found \"speed\"");
}

}  // namespace
}  // namespace traverse::evaluation
