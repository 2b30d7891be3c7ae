#include <concepts>
#include <type_traits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "traverse/evaluation/json.hpp"

#include "names.hpp"

namespace traverse::evaluation {

using Json = nlohmann::ordered_json;

namespace {

/// A value of the file that knows which keys lead to it, so that an error can name them.
class Node {
 public:
  Node(const Json& json, std::string path) : json_(json), path_(std::move(path)) {}

  Node operator[](const std::string& key) const {
    if (!json_.is_object() || !json_.contains(key)) throw missing(path_ + key, "it is not there");
    return {json_.at(key), path_ + key + "."};
  }
  Node operator[](std::size_t index) const {
    return {json_.at(index), path_ + std::to_string(index) + "."};
  }

  bool is_null() const { return json_.is_null(); }
  std::size_t size() const {
    if (!json_.is_array()) throw wrong("a list");
    return json_.size();
  }

  template <typename Value>
  Value as() const {
    if constexpr (std::same_as<Value, bool>) {
      if (!json_.is_boolean()) throw wrong("true or false");
    } else if constexpr (std::unsigned_integral<Value>) {
      if (!json_.is_number_unsigned()) throw wrong("a count");
    } else if constexpr (std::integral<Value>) {
      if (!json_.is_number_integer()) throw wrong("a whole number");
    } else if constexpr (std::floating_point<Value>) {
      if (!json_.is_number()) throw wrong("a number");
    } else {
      if (!json_.is_string()) throw wrong("a text");
    }
    return json_.get<Value>();
  }

  template <typename Value>
  std::vector<Value> list() const {
    std::vector<Value> values;
    values.reserve(size());
    for (std::size_t i = 0; i < size(); ++i) values.push_back((*this)[i].as<Value>());
    return values;
  }
  /// A list that must have `count` elements.
  template <typename Value>
  std::vector<Value> list(std::size_t count) const {
    if (size() != count) throw wrong(fmt::format("a list of {}", count));
    return list<Value>();
  }

  template <typename Value>
  std::optional<Value> optional() const {
    return is_null() ? std::nullopt : std::optional(as<Value>());
  }

  template <typename Enum, std::size_t N>
  Enum one_of(const std::array<std::pair<std::string_view, Enum>, N>& names) const {
    const auto value = value_in(names, as<std::string>());
    if (!value) throw wrong("a known name");
    return *value;
  }

  /// The named members of an object, in order.
  template <typename Visit>
  void each_member(Visit visit) const {
    if (!json_.is_object()) throw wrong("an object");
    for (const auto& item : json_.items()) visit(item.key(), (*this)[item.key()]);
  }

  EvaluationError wrong(const std::string& expected) const {
    const std::string found = json_.is_structured() ? json_.type_name() : json_.dump();
    return missing(path_.substr(0, path_.size() - 1), "expected " + expected + ", found " + found);
  }

 private:
  static EvaluationError missing(const std::string& path, const std::string& what) {
    return EvaluationError(fmt::format("not an evaluation, key {}: {}", path, what));
  }

  const Json& json_;
  std::string path_;
};

std::optional<geometry::Stamp> optional_stamp(const Node& node) {
  const auto nanoseconds = node.optional<std::int64_t>();
  return nanoseconds ? std::optional(geometry::Stamp{*nanoseconds}) : std::nullopt;
}

TrajectoryFacts facts_from(const Node& node) {
  return {node["name"].as<std::string>(), node["poses"].as<std::size_t>(),
          node["path_m"].as<double>(), optional_stamp(node["first_stamp_ns"]),
          optional_stamp(node["last_stamp_ns"])};
}

Statistics statistics_from(const Node& node) {
  return {node["rmse"].as<double>(), node["mean"].as<double>(),      node["median"].as<double>(),
          node["std"].as<double>(),  node["min"].as<double>(),       node["max"].as<double>(),
          node["sse"].as<double>(),  node["count"].as<std::size_t>()};
}

void read_association(const Node& node, Comparison& comparison) {
  Association& association = comparison.association;
  association.mode = node["by"].one_of(kAssociationNames);
  association.options = {node["max_time_difference"].as<double>(),
                         node["time_offset"].as<double>()};
  const auto pairs = node["pairs"].as<std::size_t>();
  const Node per_pair = node["per_pair"];
  const auto estimate = per_pair["estimate"].list<std::size_t>(pairs);
  const auto reference = per_pair["reference"].list<std::size_t>(pairs);
  const auto difference_s = per_pair["time_difference_s"].list<double>(pairs);
  for (std::size_t i = 0; i < pairs; ++i) {
    association.matches.push_back({estimate[i], reference[i], difference_s[i]});
  }
  if (association.mode == AssociationMode::kStamp) {
    for (const std::int64_t stamp : per_pair["stamp_ns"].list<std::int64_t>(pairs)) {
      comparison.stamps.push_back({stamp});
    }
  }
  comparison.distances_m = per_pair["distance_m"].list<double>(pairs);
}

geometry::Pose3 pose_from(const Node& rows) {
  if (rows.size() != 4) throw rows.wrong("four rows");
  Eigen::Matrix4d T;
  for (Eigen::Index row = 0; row < 4; ++row) {
    const auto numbers = rows[static_cast<std::size_t>(row)].list<double>(4);
    T.row(row) = Eigen::Map<const Eigen::RowVector4d>(numbers.data());
  }
  return geometry::Pose3::from_matrix(T);
}

Alignment alignment_from(const Node& node) {
  Alignment alignment;
  alignment.mode = node["mode"].one_of(kAlignmentNames);
  alignment.scale = node["scale"].as<double>();
  alignment.poses_used = node["poses_used"].as<std::size_t>();
  alignment.T_reference_estimate = pose_from(node["T_reference_estimate"]);
  return alignment;
}

std::vector<std::size_t> indices_from(const Node& node, std::size_t count, std::size_t below) {
  std::vector<std::size_t> indices = node.list<std::size_t>(count);
  for (const std::size_t index : indices) {
    if (index >= below) throw node.wrong(fmt::format("indices of {} pairs", below));
  }
  return indices;
}

Rpe rpe_from(const Node& node, std::size_t matches) {
  Rpe rpe;
  rpe.options.delta = {node["delta"].as<double>(), node["unit"].one_of(kDeltaUnitNames)};
  rpe.options.all_pairs = node["all_pairs"].as<bool>();
  rpe.options.pairs_from = node["pairs_from"].one_of(kPairsFromNames);
  rpe.relation = node["relation"].one_of(kRelationNames);
  rpe.dropped_without_motion = node["dropped_without_motion"].as<std::size_t>();
  rpe.statistics = statistics_from(node["stats"]);
  const std::size_t count = rpe.statistics.count;
  const Node per_pair = node["per_pair"];
  const auto from = indices_from(per_pair["from"], count, matches);
  const auto to = indices_from(per_pair["to"], count, matches);
  for (std::size_t i = 0; i < count; ++i) rpe.pairs.push_back({from[i], to[i]});
  rpe.values = per_pair["value"].list<double>(count);
  return rpe;
}

std::vector<KittiBin> bins_from(const Node& node, const char* centre) {
  std::vector<KittiBin> bins;
  for (std::size_t i = 0; i < node.size(); ++i) {
    bins.push_back({node[i][centre].as<double>(), node[i]["segments"].as<std::size_t>(),
                    node[i]["translation_percent"].as<double>(),
                    node[i]["rotation_deg_per_m"].as<double>()});
  }
  return bins;
}

KittiDrift kitti_from(const Node& node, std::size_t matches) {
  KittiDrift kitti;
  kitti.frame = node["frame"].as<std::string>();
  const Node T_body_camera = node["T_body_camera"];
  if (!T_body_camera.is_null()) kitti.T_body_camera = pose_from(T_body_camera);
  kitti.step = node["step"].as<std::size_t>();
  kitti.frame_seconds = node["frame_seconds"].as<double>();
  kitti.translation_percent = node["translation_percent"].as<double>();
  kitti.rotation_deg_per_m = node["rotation_deg_per_m"].as<double>();
  kitti.by_length = bins_from(node["by_length"], "length_m");
  kitti.by_speed = bins_from(node["by_speed"], "speed_mps");
  const auto count = node["segments"].as<std::size_t>();
  const Node per_segment = node["per_segment"];
  const auto first = indices_from(per_segment["first"], count, matches);
  const auto last = indices_from(per_segment["last"], count, matches);
  const auto length_m = per_segment["length_m"].list<double>(count);
  const auto translation = per_segment["translation_percent"].list<double>(count);
  const auto rotation = per_segment["rotation_deg_per_m"].list<double>(count);
  const auto speed_mps = per_segment["speed_mps"].list<double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    kitti.segments.push_back(
        {first[i], last[i], length_m[i], translation[i], rotation[i], speed_mps[i]});
  }
  return kitti;
}

PathFigures path_from(const Node& node) {
  return {node["estimate_m"].as<double>(), node["reference_m"].as<double>(),
          node["end_error_m"].as<double>(), node["end_error_percent"].optional<double>(),
          node["end_rotation_deg"].as<double>()};
}

Consistency consistency_from(const Node& node) {
  Consistency score;
  score.mme = node["mme"].as<double>();
  score.mpv_m = node["mpv_m"].as<double>();
  score.queries = node["queries"].as<std::size_t>();
  score.scans = node["scans"].as<std::size_t>();
  score.points = node["points"].as<std::size_t>();
  score.points_are = node["points_are"].as<std::string>();
  const Node plane = node["point_to_plane"];
  if (!plane.is_null()) {
    score.point_to_plane = {plane["queries"].as<std::size_t>(), plane["mean_m"].as<double>(),
                            plane["median_m"].as<double>(), plane["p90_m"].as<double>()};
  }
  return score;
}

Comparison comparison_from(const Node& root) {
  Comparison comparison;
  comparison.reference = facts_from(root["reference"]);
  read_association(root["association"], comparison);
  const std::size_t matches = comparison.association.matches.size();
  comparison.alignment = alignment_from(root["alignment"]);
  root["ape"].each_member([&](const std::string& name, const Node& node) {
    const auto relation = value_in(kRelationNames, name);
    if (!relation) throw node.wrong("only known relations");
    comparison.ape.push_back(
        {*relation, node["per_pair"]["value"].list<double>(matches), statistics_from(node)});
  });
  const Node rpe = root["rpe"];
  for (std::size_t i = 0; i < rpe.size(); ++i) {
    comparison.rpe.push_back(rpe_from(rpe[i], matches));
  }
  if (!root["kitti"].is_null()) comparison.kitti = kitti_from(root["kitti"], matches);
  comparison.path = path_from(root["path"]);
  const Node undefined = root["undefined"];
  for (std::size_t i = 0; i < undefined.size(); ++i) {
    comparison.undefined.push_back(
        {undefined[i]["metric"].as<std::string>(), undefined[i]["reason"].as<std::string>()});
  }
  return comparison;
}

Json parse(std::string_view text) {
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    throw EvaluationError(fmt::format("not an evaluation: no JSON from byte {} on", error.byte));
  }
}

}  // namespace

Evaluation from_json(std::string_view text) {
  const Json json = parse(text);
  const Node root(json, "");
  Evaluation evaluation;
  evaluation.estimate = facts_from(root["estimate"]);
  if (!root["reference"].is_null()) evaluation.comparison = comparison_from(root);
  if (!root["consistency"].is_null())
    evaluation.consistency = consistency_from(root["consistency"]);
  return evaluation;
}

}  // namespace traverse::evaluation
