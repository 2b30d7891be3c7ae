#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/LU>
#include <fmt/format.h>

#include "traverse/evaluation/checkpoints.hpp"
#include "traverse/evaluation/json.hpp"
#include "traverse/files/json_document.hpp"

#include "names.hpp"

namespace traverse::evaluation {

using files::JsonDocument;
using files::JsonValue;

namespace {

/// \throws files::InputError unless the list has `count` elements.
template <typename Value>
std::vector<Value> of_size(std::vector<Value> values, std::size_t count, const JsonValue& json) {
  if (values.size() != count) throw json.error(fmt::format("a list of {}", count));
  return values;
}

std::vector<double> numbers_of(const JsonValue& json, std::size_t count) {
  return of_size(json.numbers(), count, json);
}
std::vector<std::size_t> counts_of(const JsonValue& json, std::size_t count) {
  return of_size(json.counts(), count, json);
}

template <typename Enum, std::size_t N>
Enum one_of(const std::array<std::pair<std::string_view, Enum>, N>& names, const JsonValue& json) {
  const auto value = value_in(names, json.text());
  if (!value) throw json.error("a known name");
  return *value;
}

std::optional<geometry::Stamp> optional_stamp(const JsonValue& node) {
  const auto nanoseconds = node.optional_integer();
  return nanoseconds ? std::optional(geometry::Stamp{*nanoseconds}) : std::nullopt;
}

/// A text that files of version 0.1 do not have, or that is null.
std::string text_if_there(const JsonValue& node, const char* key) {
  return node.has(key) && !node[key].is_null() ? node[key].text() : std::string();
}
std::vector<std::string> texts_if_there(const JsonValue& node, const char* key) {
  return node.has(key) ? node[key].texts() : std::vector<std::string>();
}

TrajectoryFacts facts_from(const JsonValue& node) {
  return {node["name"].text(),
          node["poses"].count(),
          node["path_m"].number(),
          optional_stamp(node["first_stamp_ns"]),
          optional_stamp(node["last_stamp_ns"]),
          text_if_there(node, "read_as"),
          texts_if_there(node, "notes")};
}

Statistics statistics_from(const JsonValue& node) {
  return {node["rmse"].number(), node["mean"].number(), node["median"].number(),
          node["std"].number(),  node["min"].number(),  node["max"].number(),
          node["sse"].number(),  node["count"].count()};
}

void read_association(const JsonValue& node, Comparison& comparison) {
  Association& association = comparison.association;
  association.mode = one_of(kAssociationNames, node["by"]);
  association.options = {node["max_time_difference"].number(), node["time_offset"].number()};
  const auto pairs = node["pairs"].count();
  const JsonValue per_pair = node["per_pair"];
  const auto estimate = counts_of(per_pair["estimate"], pairs);
  const auto reference = counts_of(per_pair["reference"], pairs);
  const auto difference_s = numbers_of(per_pair["time_difference_s"], pairs);
  for (std::size_t i = 0; i < pairs; ++i) {
    association.matches.push_back({estimate[i], reference[i], difference_s[i]});
  }
  if (association.mode == AssociationMode::kStamp) {
    const JsonValue stamps = per_pair["stamp_ns"];
    for (const std::int64_t stamp : of_size(stamps.integers(), pairs, stamps)) {
      comparison.stamps.push_back({stamp});
    }
  }
  comparison.distances_m = numbers_of(per_pair["distance_m"], pairs);
  const auto& path_m = comparison.distances_m;
  if (!std::is_sorted(path_m.begin(), path_m.end()) || (!path_m.empty() && path_m.front() != 0)) {
    throw per_pair["distance_m"].error("distances from 0 on that never shrink");
  }
}

constexpr double kRotationTolerance = 1e-2;  // as of trajectory files

geometry::Pose3 pose_from(const JsonValue& rows) {
  if (rows.size() != 4) throw rows.error("four rows");
  Eigen::Matrix4d T;
  for (Eigen::Index row = 0; row < 4; ++row) {
    const auto numbers = numbers_of(rows[static_cast<std::size_t>(row)], 4);
    T.row(row) = Eigen::Map<const Eigen::RowVector4d>(numbers.data());
  }
  const geometry::Pose3 pose = geometry::Pose3::from_matrix(T);
  const Eigen::Matrix3d& R = pose.rotation;
  const double deviation = (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(deviation < kRotationTolerance && R.determinant() > 0)) {
    throw rows.error("a rotation in the first three columns", "another matrix");
  }
  return pose;
}

Alignment alignment_from(const JsonValue& node) {
  Alignment alignment;
  alignment.mode = one_of(kAlignmentNames, node["mode"]);
  alignment.scale = node["scale"].number();
  if (!(alignment.scale > 0)) throw node["scale"].error("a scale above 0");
  alignment.poses_used = node["poses_used"].count();
  alignment.T_reference_estimate = pose_from(node["T_reference_estimate"]);
  if (node.has("undetermined")) {
    alignment.undetermined = one_of(kUndeterminedNames, node["undetermined"]);
  }
  alignment.reason = text_if_there(node, "reason");
  return alignment;
}

std::vector<std::size_t> indices_from(const JsonValue& node, std::size_t count, std::size_t below) {
  std::vector<std::size_t> indices = counts_of(node, count);
  for (const std::size_t index : indices) {
    if (index >= below) {
      throw node.error(fmt::format("indices of {} pairs", below), std::to_string(index));
    }
  }
  return indices;
}

Rpe rpe_from(const JsonValue& node, std::size_t matches) {
  Rpe rpe;
  rpe.options.delta = {node["delta"].number(), one_of(kDeltaUnitNames, node["unit"])};
  rpe.options.all_pairs = node["all_pairs"].boolean();
  rpe.options.pairs_from = one_of(kPairsFromNames, node["pairs_from"]);
  rpe.relation = one_of(kRelationNames, node["relation"]);
  rpe.dropped_without_motion = node["dropped_without_motion"].count();
  rpe.statistics = statistics_from(node["stats"]);
  const std::size_t count = rpe.statistics.count;
  const JsonValue per_pair = node["per_pair"];
  const auto from = indices_from(per_pair["from"], count, matches);
  const auto to = indices_from(per_pair["to"], count, matches);
  for (std::size_t i = 0; i < count; ++i) {
    if (from[i] >= to[i]) throw per_pair["from"].error("pairs in the order of time", "others");
    rpe.pairs.push_back({from[i], to[i]});
  }
  rpe.values = numbers_of(per_pair["value"], count);
  return rpe;
}

std::vector<KittiBin> bins_from(const JsonValue& node, const char* centre) {
  std::vector<KittiBin> bins;
  for (std::size_t i = 0; i < node.size(); ++i) {
    bins.push_back({node[i][centre].number(), node[i]["segments"].count(),
                    node[i]["translation_percent"].number(),
                    node[i]["rotation_deg_per_m"].number()});
  }
  return bins;
}

KittiDrift kitti_from(const JsonValue& node, std::size_t matches) {
  KittiDrift kitti;
  kitti.frame = node["frame"].text();
  const JsonValue T_body_camera = node["T_body_camera"];
  if (!T_body_camera.is_null()) kitti.T_body_camera = pose_from(T_body_camera);
  kitti.step = node["step"].count();
  kitti.frame_seconds = node["frame_seconds"].number();
  kitti.translation_percent = node["translation_percent"].number();
  kitti.rotation_deg_per_m = node["rotation_deg_per_m"].number();
  kitti.by_length = bins_from(node["by_length"], "length_m");
  kitti.by_speed = bins_from(node["by_speed"], "speed_mps");
  const auto count = node["segments"].count();
  const JsonValue per_segment = node["per_segment"];
  const auto first = indices_from(per_segment["first"], count, matches);
  const auto last = indices_from(per_segment["last"], count, matches);
  const auto length_m = numbers_of(per_segment["length_m"], count);
  const auto translation = numbers_of(per_segment["translation_percent"], count);
  const auto rotation = numbers_of(per_segment["rotation_deg_per_m"], count);
  const auto speed_mps = numbers_of(per_segment["speed_mps"], count);
  for (std::size_t i = 0; i < count; ++i) {
    if (first[i] > last[i]) throw per_segment["first"].error("segments in the order of time");
    kitti.segments.push_back(
        {first[i], last[i], length_m[i], translation[i], rotation[i], speed_mps[i]});
  }
  return kitti;
}

std::vector<SubTrajectoryErrors> sub_trajectories_from(const JsonValue& node) {
  std::vector<SubTrajectoryErrors> list;
  for (std::size_t i = 0; i < node.size(); ++i) {
    const JsonValue of = node[i];
    list.push_back({of["length_m"].number(), statistics_from(of["translation_m"]),
                    statistics_from(of["translation_percent"]), statistics_from(of["rotation_deg"]),
                    statistics_from(of["rotation_deg_per_m"]), statistics_from(of["yaw_deg"]),
                    statistics_from(of["gravity_deg"])});
  }
  return list;
}

ErrorPart part_from(const JsonValue& node) {
  return {node["rmse"].number(), node["mean"].number(), node["max"].number()};
}

ErrorSplit split_from(const JsonValue& node) {
  return {part_from(node["along"]), part_from(node["across"]), part_from(node["up"]),
          node["poses"].count(), node["alternating_m"].optional_number()};
}

PathFigures path_from(const JsonValue& node) {
  return {node["estimate_m"].number(), node["reference_m"].number(), node["end_error_m"].number(),
          node["end_error_percent"].optional_number(), node["end_rotation_deg"].number()};
}

Consistency consistency_from(const JsonValue& node) {
  Consistency score;
  score.mme = node["mme"].number();
  score.mpv_m = node["mpv_m"].number();
  score.queries = node["queries"].count();
  score.scans = node["scans"].count();
  score.points = node["points"].count();
  score.points_are = node["points_are"].text();
  const JsonValue plane = node["point_to_plane"];
  if (!plane.is_null()) {
    score.point_to_plane = {plane["queries"].count(), plane["mean_m"].number(),
                            plane["median_m"].number(), plane["p90_m"].number()};
  }
  return score;
}

std::vector<Ape> ape_from(const JsonValue& by_relation, std::size_t matches) {
  std::vector<Ape> list;
  for (const std::string& name : by_relation.keys()) {
    const JsonValue ape = by_relation[name];
    const auto relation = value_in(kRelationNames, name);
    if (!relation) throw ape.error("only known relations", name);
    list.push_back(
        {*relation, numbers_of(ape["per_pair"]["value"], matches), statistics_from(ape)});
  }
  return list;
}

Comparison comparison_from(const JsonValue& root) {
  Comparison comparison;
  comparison.reference = facts_from(root["reference"]);
  read_association(root["association"], comparison);
  const std::size_t matches = comparison.association.matches.size();
  comparison.alignment = alignment_from(root["alignment"]);
  comparison.ape = ape_from(root["ape"], matches);
  if (root.has("ape_at_origin")) {
    comparison.ape_at_origin = ape_from(root["ape_at_origin"], matches);
  }
  if (root.has("split") && !root["split"].is_null()) comparison.split = split_from(root["split"]);
  const JsonValue rpe = root["rpe"];
  for (std::size_t i = 0; i < rpe.size(); ++i) {
    comparison.rpe.push_back(rpe_from(rpe[i], matches));
  }
  if (!root["kitti"].is_null()) comparison.kitti = kitti_from(root["kitti"], matches);
  if (root.has("sub_trajectories") && !root["sub_trajectories"].is_null()) {
    comparison.sub_trajectories = sub_trajectories_from(root["sub_trajectories"]["lengths"]);
  }
  comparison.path = path_from(root["path"]);
  const JsonValue undefined = root["undefined"];
  for (std::size_t i = 0; i < undefined.size(); ++i) {
    comparison.undefined.push_back({undefined[i]["metric"].text(), undefined[i]["reason"].text()});
  }
  comparison.warnings = texts_if_there(root, "warnings");
  return comparison;
}

Evaluation evaluation_from(const JsonValue& root) {
  Evaluation evaluation;
  evaluation.estimate = facts_from(root["estimate"]);
  if (!root["reference"].is_null()) evaluation.comparison = comparison_from(root);
  if (!root["consistency"].is_null())
    evaluation.consistency = consistency_from(root["consistency"]);
  return evaluation;
}

Eigen::Vector3d three_from(const JsonValue& node) {
  const auto numbers = numbers_of(node, 3);
  return {numbers[0], numbers[1], numbers[2]};
}

std::optional<CheckpointFigures> checkpoint_figures_from(const JsonValue& node) {
  if (node.is_null()) return std::nullopt;
  CheckpointFigures figures;
  figures.count = node["count"].count();
  figures.rmse_m = three_from(node["rmse_m"]);
  figures.rmse_horizontal_m = node["rmse_horizontal_m"].number();
  figures.rmse_vertical_m = node["rmse_vertical_m"].number();
  figures.rmse_3d_m = node["rmse_3d_m"].number();
  figures.p95_horizontal_m = node["p95_horizontal_m"].number();
  figures.p95_vertical_m = node["p95_vertical_m"].number();
  figures.survey_horizontal_m = node["survey_horizontal_m"].number();
  figures.survey_vertical_m = node["survey_vertical_m"].number();
  figures.normalised_horizontal = node["normalised_horizontal"].optional_number();
  figures.normalised_vertical = node["normalised_vertical"].optional_number();
  figures.weighted_horizontal_m = node["weighted_horizontal_m"].optional_number();
  figures.weighted_vertical_m = node["weighted_vertical_m"].optional_number();
  return figures;
}

CheckpointEvaluation checkpoints_from(const JsonValue& root) {
  CheckpointEvaluation evaluation;
  const JsonValue alignment = root["alignment"];
  evaluation.alignment = one_of(kAlignmentNames, alignment["mode"]);
  evaluation.aligned_by = alignment["points"].count();
  evaluation.is_by_all = alignment["by_all"].boolean();
  evaluation.enh_map.scale = alignment["scale"].number();
  for (std::size_t row = 0; row < 3; ++row) {
    evaluation.enh_map.T_y_x.rotation.row(static_cast<Eigen::Index>(row)) =
        three_from(alignment["rotation"][row]).transpose();
  }
  evaluation.enh_map.T_y_x.translation = three_from(alignment["translation_m"]);
  const JsonValue residuals = root["residuals"];
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const JsonValue of = residuals[i];
    CheckpointResidual residual;
    residual.point.name = of["name"].text();
    residual.point.is_control = of["use"].text() == "control";
    residual.point.p_enh = three_from(of["surveyed_m"]);
    residual.point.sigma_m = three_from(of["sigma_m"]);
    residual.estimate_enh = three_from(of["estimate_m"]);
    residual.residual_m = three_from(of["residual_m"]);
    evaluation.residuals.push_back(std::move(residual));
  }
  evaluation.control = checkpoint_figures_from(root["control"]);
  evaluation.check = checkpoint_figures_from(root["check"]);
  evaluation.notes = root["notes"].texts();
  return evaluation;
}

}  // namespace

CheckpointEvaluation read_checkpoint_evaluation(const std::filesystem::path& file) {
  return checkpoints_from(JsonDocument::read(file).root());
}

Evaluation from_json(std::string_view text) {
  try {
    return evaluation_from(JsonDocument::parse(text).root());
  } catch (const files::InputError& error) {
    throw EvaluationError(fmt::format("not an evaluation, {}: expected {}, found {}",
                                      error.place().text, error.expected(), error.found()));
  }
}

Evaluation read_evaluation(const std::filesystem::path& file) {
  return evaluation_from(JsonDocument::read(file).root());
}

}  // namespace traverse::evaluation
