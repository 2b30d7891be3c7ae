#include "recording_report.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "table.hpp"

namespace traverse::app {

using dataset::LidarSurvey;
using dataset::RecordingSurvey;
using dataset::Source;
using dataset::Spread;
using dataset::StreamSurvey;
using dataset::TroubledScan;

namespace {

constexpr std::size_t kIndent = 2;
constexpr std::size_t kItemsShown = 5;  // of gaps, troubled scans and places

std::string rate_text(const StreamSurvey& stream) {
  return stream.rate_hz() > 0 ? fmt::format("{:.4g} Hz", stream.rate_hz()) : "-";
}

std::string spread_text(const Spread& spread) {
  return fmt::format("{} / {} / {}", spread.least, spread.median, spread.most);
}

std::string and_more(std::size_t all) {
  return all > kItemsShown ? fmt::format("and {} more", all - kItemsShown) : "";
}

std::string sensors_text(const RecordingSurvey& survey) {
  Table table({{},
               {},
               {Table::Align::kRight},
               {Table::Align::kRight},
               {Table::Align::kRight},
               {Table::Align::kRight},
               {Table::Align::kRight}});
  table.add_row({"sensor", "kind", "records", "rate", "interval", "duration", "gaps"});
  for (const StreamSurvey& stream : survey.streams) {
    table.add_row(
        {stream.sensor, std::string(name_of(stream.kind)), fmt::format("{}", stream.count),
         rate_text(stream), fmt::format("{:.4f} s", stream.median_interval_s),
         fmt::format("{:.3f} s", stream.duration_s()), fmt::format("{}", stream.gaps.size())});
  }
  return "Sensors\n" + table.text(kIndent);
}

std::string topics_text(const dataset::RecordingInfo& info) {
  if (info.topics.empty()) return {};
  Table table(
      {{}, {}, {Table::Align::kRight}, {Table::Align::kRight}, {}, {Table::Align::kLeft, 44}});
  table.add_row({"topic", "type", "messages", "rate", "used as", "because"});
  for (const dataset::TopicInfo& topic : info.topics) {
    table.add_row({topic.topic, topic.type, fmt::format("{}", topic.count),
                   topic.rate_hz > 0 ? fmt::format("{:.4g} Hz", topic.rate_hz) : "-",
                   topic.use.empty() ? "-" : topic.use, topic.why});
  }
  return "\nTopics\n" + table.text(kIndent);
}

std::string gaps_text(const RecordingSurvey& survey) {
  std::string text;
  for (const StreamSurvey& stream : survey.streams) {
    if (stream.gaps.empty()) continue;
    text += fmt::format("\nGaps of {}: more than three intervals\n", stream.sensor);
    for (std::size_t i = 0; i < std::min(stream.gaps.size(), kItemsShown); ++i) {
      text += fmt::format("  {:.3f} s from {}\n", stream.gaps[i].seconds,
                          to_text(stream.gaps[i].begin));
    }
    if (stream.gaps.size() > kItemsShown) text += "  " + and_more(stream.gaps.size()) + "\n";
  }
  return text;
}

std::string rings_text(const LidarSurvey& lidar) {
  if (!lidar.rings) return "unknown: " + lidar.why_no_rings;
  return spread_text(*lidar.rings) +
         (lidar.rings_expected > 0 ? fmt::format("  ({} expected)", lidar.rings_expected) : "");
}

std::string trouble_text(const TroubledScan& scan) {
  std::string text;
  const auto add = [&](std::size_t count, const char* what) {
    if (count == 0) return;
    if (!text.empty()) text += ", ";
    text += fmt::format("{} {}", count, what);
  };
  add(scan.points.not_finite, "points not finite");
  add(scan.points.at_origin, "points at the origin");
  add(scan.points_beyond_rings, "points beyond the rings expected");
  add(scan.has_one_ring ? 1 : 0, "ring only");
  return text;
}

std::string lidar_text(const std::string& sensor, const LidarSurvey& lidar) {
  Table table({{}, {Table::Align::kLeft, 90}});
  table.add_row({"points per scan", spread_text(lidar.points) + "  (least / median / most)"});
  table.add_row({"rings", rings_text(lidar)});
  table.add_row({"intensity", lidar.has_intensity ? "yes" : "no"});
  table.add_row(
      {"stored times", lidar.has_stored_times
                           ? fmt::format("{:.4f} to {:.4f} s around the stamp",
                                         lidar.earliest_point_time_s, lidar.latest_point_time_s)
                           : "no"});
  table.add_row({"troubled scans", fmt::format("{}", lidar.troubled.size())});
  for (std::size_t i = 0; i < std::min(lidar.troubled.size(), kItemsShown); ++i) {
    const TroubledScan& scan = lidar.troubled[i];
    table.add_row({"", fmt::format("frame {}: {}", scan.frame, trouble_text(scan))});
  }
  if (lidar.troubled.size() > kItemsShown) table.add_row({"", and_more(lidar.troubled.size())});
  return fmt::format("\nScans of {}\n", sensor) + table.text(kIndent);
}

std::string facts_text(const Source& source) {
  Table table({{}, {Table::Align::kLeft, 52}, {Table::Align::kLeft, 44}});
  table.add_row({"fact", "value", "because"});
  for (const dataset::Fact& fact : source.info().facts) {
    if (fact.name != dataset::kNotUsed) table.add_row({fact.name, fact.value, fact.reason});
  }
  return "\nTaken for true\n" + table.text(kIndent);
}

/// Each option on one line, to be copied.
std::string unused_text(const Source& source) {
  std::string text;
  for (const dataset::Fact& fact : source.info().facts) {
    if (fact.name != dataset::kNotUsed) continue;
    text += fmt::format("  {}\n      {}\n", fact.value, fact.reason);
  }
  return text.empty() ? text : "\nNot used\n" + text;
}

std::string findings_text(const std::vector<plausibility::Finding>& findings) {
  if (findings.empty()) return "\nContradictions: none\n";
  std::string text = fmt::format("\nContradictions: {}\n", findings.size());
  for (const plausibility::Finding& finding : findings) {
    const bool refuses = finding.severity == plausibility::Severity::kRefuse;
    text += fmt::format("  {}\n", plausibility::to_text(finding));
    if (finding.is_accepted) {
      text += "      accepted\n";
    } else if (refuses) {
      text += fmt::format("      a run that depends on it is refused without --accept {}\n",
                          finding.code);
    }
  }
  return text;
}

std::string reference_text(const RecordingSurvey& survey) {
  if (!survey.reference) return "\nReference: none\n";
  const auto& reference = *survey.reference;
  return fmt::format("\nReference: {} poses, {:.2f} m, {:.3f} s; it covers {:.1f} % of the scans\n",
                     reference.poses, reference.length_m,
                     seconds_between(reference.first, reference.last),
                     100 * reference.share_covered);
}

std::string skipped_text(const dataset::SkippedRecords& skipped) {
  if (skipped.empty()) return "\nSkipped records: none\n";
  std::string text = fmt::format("\nSkipped records: {}\n", skipped.total());
  for (const auto& [reason, count] : skipped.by_reason()) {
    text += fmt::format("  {} x {}\n", count.count, reason);
    for (std::size_t i = 0; i < std::min(count.first_places.size(), kItemsShown); ++i) {
      text += "      " + count.first_places[i] + "\n";
    }
    if (count.count > kItemsShown) text += "      " + and_more(count.count) + "\n";
  }
  return text;
}

}  // namespace

std::string recording_text(const Source& source, const RecordingSurvey& survey,
                           const std::vector<plausibility::Finding>& findings) {
  const dataset::RecordingInfo& info = source.info();
  std::string text = fmt::format("{}  ({}, {})\n{} records in {:.3f} s\n\n", info.name, info.format,
                                 info.path.string(), survey.measurements(), survey.duration_s());
  text += sensors_text(survey) + topics_text(info) + gaps_text(survey);
  for (const StreamSurvey& stream : survey.streams) {
    if (stream.lidar) text += lidar_text(stream.sensor, *stream.lidar);
  }
  return text + facts_text(source) + unused_text(source) + reference_text(survey) +
         skipped_text(source.skipped()) + findings_text(findings);
}

std::string listed_text(const Source& source, const RecordingSurvey& survey) {
  const dataset::RecordingInfo& info = source.info();
  std::string text =
      fmt::format("{}  ({}, {})\n", info.name, info.format, info.path.string()) + topics_text(info);
  std::size_t scans = 0;
  for (const StreamSurvey& stream : survey.streams) {
    if (!stream.lidar) continue;
    text += lidar_text(stream.sensor, *stream.lidar);
    scans += stream.count;
  }
  text += facts_text(source) + unused_text(source) + skipped_text(source.skipped());
  return text + fmt::format(
                    "\nOf the first {} records ({} scans): `traverse info --all` reads all, "
                    "counts gaps and looks for contradictions.\n",
                    survey.measurements(), scans);
}

}  // namespace traverse::app
