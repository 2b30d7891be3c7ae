#include <algorithm>
#include <cstddef>
#include <functional>
#include <ostream>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "traverse/evaluation/json.hpp"
#include "traverse/evaluation/titles.hpp"

namespace traverse::evaluation {

using Json = nlohmann::ordered_json;

namespace {

/// Turns an evaluation into JSON. Long arrays do not become JSON in memory, where a number takes
/// twice its size and the text of all of them more: they are columns, in whose place the document
/// has a binary value, which evaluations have none of, of the column's number.
class Document {
 public:
  /// An array with what `value` tells of each element, which must outlive the document.
  template <typename Element, typename Value>
  Json column(const std::vector<Element>& elements, Value value) {
    columns_.push_back([&elements, value](std::ostream& stream) {
      constexpr std::size_t kAtOnce = 1024;
      stream << '[';
      for (std::size_t begin = 0; begin < elements.size(); begin += kAtOnce) {
        Json part = Json::array();
        for (std::size_t i = begin; i < std::min(begin + kAtOnce, elements.size()); ++i) {
          part.push_back(std::invoke(value, elements[i]));
        }
        const std::string text = part.dump();
        stream << (begin > 0 ? "," : "") << std::string_view(text).substr(1, text.size() - 2);
      }
      stream << ']';
    });
    return Json::binary({}, columns_.size() - 1);
  }
  Json column(const std::vector<double>& values) { return column(values, std::identity()); }

  /// Objects over several lines, arrays of plain values on one: readable by eye and by `diff`.
  void print(const Json& json, std::size_t indent, std::ostream& stream) const {
    if (json.is_binary()) return columns_.at(json.get_binary().subtype())(stream);
    const bool nested = std::any_of(json.begin(), json.end(),
                                    [](const Json& child) { return child.is_structured(); });
    if (json.empty() || !(json.is_object() || (json.is_array() && nested))) {
      stream << json.dump(-1, ' ', false, Json::error_handler_t::replace);
      return;
    }
    const std::string inner(indent + 2, ' ');
    stream << (json.is_object() ? "{\n" : "[\n");
    for (auto item = json.begin(); item != json.end(); ++item) {
      if (item != json.begin()) stream << ",\n";
      stream << inner;
      if (json.is_object()) stream << Json(item.key()).dump() << ": ";
      print(*item, indent + 2, stream);
    }
    stream << '\n' << std::string(indent, ' ') << (json.is_object() ? '}' : ']');
  }

 private:
  std::vector<std::function<void(std::ostream&)>> columns_;
};

Json optional_number(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

Json optional_stamp(const std::optional<geometry::Stamp>& stamp) {
  return stamp ? Json(stamp->nanoseconds) : Json();
}

Json json_of(const TrajectoryFacts& facts) {
  return {{"name", facts.name},
          {"poses", facts.poses},
          {"path_m", facts.path_m},
          {"first_stamp_ns", optional_stamp(facts.first)},
          {"last_stamp_ns", optional_stamp(facts.last)},
          {"read_as", facts.read_as.empty() ? Json() : Json(facts.read_as)},
          {"notes", facts.notes}};
}

Json json_of(const Statistics& s) {
  return {{"rmse", s.rmse}, {"mean", s.mean}, {"median", s.median}, {"std", s.std},
          {"min", s.min},   {"max", s.max},   {"sse", s.sse},       {"count", s.count}};
}

Json association_json(const Comparison& comparison, Document& document) {
  const Association& association = comparison.association;
  const bool by_stamp = association.mode == AssociationMode::kStamp;
  const Json per_pair = {
      {"estimate", document.column(association.matches, &Match::estimate)},
      {"reference", document.column(association.matches, &Match::reference)},
      {"time_difference_s", document.column(association.matches, &Match::time_difference_s)},
      {"stamp_ns", by_stamp ? document.column(comparison.stamps, &geometry::Stamp::nanoseconds)
                            : Json(nullptr)},
      {"distance_m", document.column(comparison.distances_m)}};
  return {{"by", name_of(association.mode)},
          {"pairs", association.matches.size()},
          {"max_time_difference", association.options.max_time_difference_s},
          {"time_offset", association.options.time_offset_s},
          {"largest_time_difference", association.largest_time_difference_s()},
          {"how", describe(association)},
          {"per_pair", per_pair}};
}

Json json_of(const geometry::Pose3& pose) {
  const Eigen::Matrix4d T = pose.matrix();
  Json rows = Json::array();
  for (Eigen::Index row = 0; row < 4; ++row) {
    rows.push_back({T(row, 0), T(row, 1), T(row, 2), T(row, 3)});
  }
  return rows;
}

Json alignment_json(const Comparison& comparison) {
  const Alignment& alignment = comparison.alignment;
  return {{"mode", name_of(alignment.mode)},
          {"scale", alignment.scale},
          {"T_reference_estimate", json_of(alignment.T_reference_estimate)},
          {"poses_used", alignment.poses_used},
          {"undetermined", name_of(alignment.undetermined)},
          {"reason", alignment.reason.empty() ? Json() : Json(alignment.reason)},
          {"how", describe(alignment, comparison.association.matches.size())}};
}

Json ape_json(const std::vector<Ape>& list, const std::function<std::string(const Ape&)>& how,
              Document& document) {
  Json by_relation = Json::object();
  for (const Ape& ape : list) {
    Json entry = json_of(ape.statistics);
    entry["unit"] = unit_of(ape.relation);
    entry["how"] = how(ape);
    entry["per_pair"] = {{"value", document.column(ape.values)}};
    by_relation[std::string(name_of(ape.relation))] = std::move(entry);
  }
  return by_relation;
}

Json json_of(const ErrorPart& part) {
  return {{"rmse", part.rmse_m}, {"mean", part.mean_m}, {"max", part.max_m}};
}

Json split_json(const Comparison& comparison) {
  if (!comparison.split) return nullptr;
  const ErrorSplit& split = *comparison.split;
  return {{"along", json_of(split.along)}, {"across", json_of(split.across)},
          {"up", json_of(split.up)},       {"unit", "m"},
          {"poses", split.poses},          {"alternating_m", optional_number(split.alternating_m)},
          {"how", split_title(comparison)}};
}

Json rpe_json(const Comparison& comparison, Document& document) {
  Json list = Json::array();
  for (const Rpe& rpe : comparison.rpe) {
    list.push_back({{"delta", rpe.options.delta.value},
                    {"unit", name_of(rpe.options.delta.unit)},
                    {"all_pairs", rpe.options.all_pairs},
                    {"pairs_from", name_of(rpe.options.pairs_from)},
                    {"relation", name_of(rpe.relation)},
                    {"relation_unit", unit_of(rpe.relation)},
                    {"stats", json_of(rpe.statistics)},
                    {"dropped_without_motion", rpe.dropped_without_motion},
                    {"how", title(rpe, comparison)},
                    {"per_pair",
                     {{"from", document.column(rpe.pairs, &IndexPair::from)},
                      {"to", document.column(rpe.pairs, &IndexPair::to)},
                      {"value", document.column(rpe.values)}}}});
  }
  return list;
}

Json bins_json(const std::vector<KittiBin>& bins, const char* centre) {
  Json list = Json::array();
  for (const KittiBin& bin : bins) {
    list.push_back({{centre, bin.centre},
                    {"segments", bin.segments},
                    {"translation_percent", bin.translation_percent},
                    {"rotation_deg_per_m", bin.rotation_deg_per_m}});
  }
  return list;
}

Json json_of(const KittiDrift& kitti, Document& document) {
  const auto& segments = kitti.segments;
  const Json per_segment = {
      {"first", document.column(segments, &KittiSegment::first)},
      {"last", document.column(segments, &KittiSegment::last)},
      {"length_m", document.column(segments, &KittiSegment::length_m)},
      {"translation_percent", document.column(segments, &KittiSegment::translation_percent)},
      {"rotation_deg_per_m", document.column(segments, &KittiSegment::rotation_deg_per_m)},
      {"speed_mps", document.column(segments, &KittiSegment::speed_mps)}};
  return {{"frame", kitti.frame},
          {"T_body_camera", kitti.T_body_camera ? json_of(*kitti.T_body_camera) : Json()},
          {"segments", segments.size()},
          {"translation_percent", kitti.translation_percent},
          {"rotation_deg_per_m", kitti.rotation_deg_per_m},
          {"by_length", bins_json(kitti.by_length, "length_m")},
          {"by_speed", bins_json(kitti.by_speed, "speed_mps")},
          {"step", kitti.step},
          {"frame_seconds", kitti.frame_seconds},
          {"how", title(kitti)},
          {"per_segment", per_segment}};
}

Json path_json(const Comparison& comparison) {
  const PathFigures& path = comparison.path;
  return {{"estimate_m", path.estimate_m},
          {"reference_m", path.reference_m},
          {"end_error_m", path.end_error_m},
          {"end_error_percent", optional_number(path.end_error_percent)},
          {"end_rotation_deg", path.end_rotation_deg},
          {"how", path_title(comparison)}};
}

Json json_of(const Consistency& score) {
  Json point_to_plane;
  if (score.point_to_plane) {
    point_to_plane = {{"queries", score.point_to_plane->queries},
                      {"mean_m", score.point_to_plane->mean_m},
                      {"median_m", score.point_to_plane->median_m},
                      {"p90_m", score.point_to_plane->p90_m}};
  }
  return {{"mme", score.mme},         {"mpv_m", score.mpv_m},
          {"queries", score.queries}, {"scans", score.scans},
          {"points", score.points},   {"points_are", score.points_are},
          {"how", title(score)},      {"point_to_plane", point_to_plane}};
}

Json sub_trajectories_json(const Comparison& comparison) {
  if (comparison.sub_trajectories.empty()) return nullptr;
  Json lengths = Json::array();
  for (const SubTrajectoryErrors& errors : comparison.sub_trajectories) {
    lengths.push_back({{"length_m", errors.length_m},
                       {"translation_m", json_of(errors.translation_m)},
                       {"translation_percent", json_of(errors.translation_percent)},
                       {"rotation_deg", json_of(errors.rotation_deg)},
                       {"rotation_deg_per_m", json_of(errors.rotation_deg_per_m)},
                       {"yaw_deg", json_of(errors.yaw_deg)},
                       {"gravity_deg", json_of(errors.gravity_deg)}});
  }
  return {{"lengths", std::move(lengths)}, {"how", sub_trajectories_title(comparison)}};
}

void add_comparison(Json& json, const Comparison& comparison, Document& document) {
  json["reference"] = json_of(comparison.reference);
  json["association"] = association_json(comparison, document);
  json["alignment"] = alignment_json(comparison);
  json["ape"] = ape_json(
      comparison.ape, [&](const Ape& ape) { return title(ape, comparison); }, document);
  if (!comparison.ape_at_origin.empty()) {
    json["ape_at_origin"] = ape_json(comparison.ape_at_origin, title_at_origin, document);
  }
  json["split"] = split_json(comparison);
  json["rpe"] = rpe_json(comparison, document);
  json["kitti"] = comparison.kitti ? json_of(*comparison.kitti, document) : Json();
  json["sub_trajectories"] = sub_trajectories_json(comparison);
  json["path"] = path_json(comparison);
}

void add_no_comparison(Json& json, const TrajectoryFacts& estimate) {
  for (const char* key : {"reference", "association", "alignment"}) json[key] = nullptr;
  json["ape"] = Json::object();
  json["split"] = nullptr;
  json["rpe"] = Json::array();
  json["kitti"] = nullptr;
  json["sub_trajectories"] = nullptr;
  json["path"] = {
      {"estimate_m", estimate.path_m}, {"reference_m", nullptr},
      {"end_error_m", nullptr},        {"end_error_percent", nullptr},
      {"end_rotation_deg", nullptr},   {"how", "path of the whole estimate, no reference"}};
}

}  // namespace

void write_json(const Evaluation& evaluation, std::ostream& stream) {
  Document document;
  Json json;
  json["estimate"] = json_of(evaluation.estimate);
  if (evaluation.comparison) {
    add_comparison(json, *evaluation.comparison, document);
  } else {
    add_no_comparison(json, evaluation.estimate);
  }
  json["consistency"] = evaluation.consistency ? json_of(*evaluation.consistency) : Json();
  Json undefined = Json::array();
  if (evaluation.comparison) {
    for (const Undefined& item : evaluation.comparison->undefined) {
      undefined.push_back({{"metric", item.metric}, {"reason", item.reason}});
    }
  }
  json["undefined"] = std::move(undefined);
  json["warnings"] =
      evaluation.comparison ? evaluation.comparison->warnings : std::vector<std::string>{};
  document.print(json, 0, stream);
  stream << '\n';
}

std::string to_json(const Evaluation& evaluation) {
  std::ostringstream stream;
  write_json(evaluation, stream);
  return std::move(stream).str();
}

}  // namespace traverse::evaluation
