#include <nlohmann/json.hpp>

#include "recording_report.hpp"

namespace traverse::app {

using dataset::LidarSurvey;
using dataset::RecordingSurvey;
using dataset::Spread;
using dataset::StreamSurvey;
using nlohmann::ordered_json;

namespace {

ordered_json to_json(const Spread& spread) {
  return {{"min", spread.least}, {"median", spread.median}, {"max", spread.most}};
}

ordered_json to_json(const LidarSurvey& lidar) {
  ordered_json troubled = ordered_json::array();
  for (const auto& scan : lidar.troubled) {
    troubled.push_back({{"frame", scan.frame},
                        {"stamp", to_text(scan.stamp)},
                        {"not_finite", scan.points.not_finite},
                        {"at_origin", scan.points.at_origin},
                        {"beyond_rings", scan.points_beyond_rings},
                        {"one_ring", scan.has_one_ring}});
  }
  ordered_json json{{"points", to_json(lidar.points)},
                    {"rings", lidar.rings ? to_json(*lidar.rings) : ordered_json()},
                    {"rings_expected", lidar.rings_expected},
                    {"intensity", lidar.has_intensity}};
  json["stored_times_s"] =
      lidar.has_stored_times
          ? ordered_json::array({lidar.earliest_point_time_s, lidar.latest_point_time_s})
          : ordered_json();
  json["troubled"] = std::move(troubled);
  return json;
}

ordered_json to_json(const StreamSurvey& stream) {
  ordered_json gaps = ordered_json::array();
  for (const auto& gap : stream.gaps) {
    gaps.push_back({{"begin", to_text(gap.begin)}, {"seconds", gap.seconds}});
  }
  ordered_json json{{"sensor", stream.sensor},
                    {"kind", name_of(stream.kind)},
                    {"records", stream.count},
                    {"first", to_text(stream.first)},
                    {"last", to_text(stream.last)},
                    {"rate_hz", stream.rate_hz()},
                    {"median_interval_s", stream.median_interval_s},
                    {"gaps", std::move(gaps)}};
  if (stream.lidar) json["lidar"] = to_json(*stream.lidar);
  return json;
}

ordered_json skipped_json(const dataset::SkippedRecords& skipped) {
  ordered_json json = ordered_json::object();
  for (const auto& [reason, count] : skipped.by_reason()) {
    json[reason] = {{"count", count.count}, {"first_places", count.first_places}};
  }
  return json;
}

}  // namespace

std::string recording_json(const dataset::Source& source, const RecordingSurvey& survey,
                           const std::vector<plausibility::Finding>& findings) {
  const dataset::RecordingInfo& info = source.info();
  ordered_json json{{"path", info.path.string()},
                    {"format", info.format},
                    {"name", info.name},
                    {"body_frame", info.rig.body_frame},
                    {"motion_compensated", info.motion_compensated},
                    {"records", survey.measurements()},
                    {"duration_s", survey.duration_s()}};
  json["sensors"] = ordered_json::array();
  for (const StreamSurvey& stream : survey.streams) json["sensors"].push_back(to_json(stream));
  if (!info.topics.empty()) {
    json["topics"] = ordered_json::array();
    for (const dataset::TopicInfo& topic : info.topics) {
      json["topics"].push_back({{"topic", topic.topic},
                                {"type", topic.type},
                                {"messages", topic.count},
                                {"rate_hz", topic.rate_hz},
                                {"used_as", topic.use},
                                {"reason", topic.why}});
    }
  }
  json["facts"] = ordered_json::array();
  for (const dataset::Fact& fact : info.facts) {
    json["facts"].push_back({{"name", fact.name}, {"value", fact.value}, {"reason", fact.reason}});
  }
  json["reference"] = nullptr;
  if (survey.reference && source.reference()) {
    json["reference"] = {{"file", source.reference()->file.string()},
                         {"description", source.reference()->description},
                         {"poses", survey.reference->poses},
                         {"length_m", survey.reference->length_m},
                         {"first", to_text(survey.reference->first)},
                         {"last", to_text(survey.reference->last)},
                         {"share_covered", survey.reference->share_covered}};
  }
  json["skipped"] = skipped_json(source.skipped());
  json["contradictions"] = ordered_json::array();
  for (const plausibility::Finding& finding : findings) {
    json["contradictions"].push_back({{"code", finding.code},
                                      {"severity", name_of(finding.severity)},
                                      {"accepted", finding.is_accepted},
                                      {"sensor", finding.sensor},
                                      {"figure", finding.figure},
                                      {"consequence", finding.consequence},
                                      {"statement", finding.statement}});
  }
  // Names and labels come from foreign files: bytes that are not UTF-8 are replaced.
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace traverse::app
