#include "results/report_data.hpp"

#include <map>
#include <set>
#include <vector>

#include <nlohmann/json.hpp>

#include "traverse/batch/metric.hpp"

namespace traverse::batch {

namespace {

using Json = nlohmann::ordered_json;

Json metrics_json(const Plan& plan) {
  Json list = Json::array();
  for (const std::string& key : plan.metrics) {
    const Metric& metric = *find_metric(key);
    list.push_back({{"key", key},
                    {"title", metric.title},
                    {"unit", metric.unit},
                    {"lower", metric.lower_is_better},
                    {"higher", metric.higher_is_better}});
  }
  return list;
}

Json kitti_json(const KittiAverages& kitti) {
  return {{"segments", kitti.segments},
          {"translation",
           {{"all_segments", kitti.translation_all_segments_percent},
            {"per_recording", kitti.translation_per_recording_percent}}},
          {"rotation",
           {{"all_segments", kitti.rotation_all_segments_deg_per_m},
            {"per_recording", kitti.rotation_per_recording_deg_per_m}}}};
}

Json variants_json(const ReportData& data) {
  Json list = Json::array();
  for (const VariantSummary& variant : data.variants) {
    Json means = Json::array();
    for (const std::string& key : data.plan.metrics) {
      const auto mean = variant.means.find(key);
      means.push_back(mean == variant.means.end() ? Json(nullptr) : Json(mean->second));
    }
    list.push_back({{"name", variant.variant},
                    {"pipeline", variant.pipeline},
                    {"settings", variant.settings},
                    {"runs", variant.runs},
                    {"ok", variant.ok},
                    {"over_budget", variant.over_budget},
                    {"means", std::move(means)},
                    {"kitti", variant.kitti ? kitti_json(*variant.kitti) : Json(nullptr)}});
  }
  return list;
}

Json planned_variants_json(const Results& results) {
  Json list = Json::array();
  std::set<std::string> seen;
  for (const Job& job : results.jobs()) {
    if (seen.insert(job.variant()).second) list.push_back(job.settings);
  }
  return list;
}

/// Drift of a run over each length of stretches, as "lengths" of the page has them; null for a run
/// without any.
Json drift_by_length(const std::map<std::string_view, double>& known) {
  Json drift = Json::array();
  bool any = false;
  const auto add = [&](const std::string& key) {
    const auto value = known.find(key);
    any = any || value != known.end();
    drift.push_back(value == known.end() ? Json(nullptr) : Json(value->second));
  };
  for (const int length_m : kKittiLengths_m) add(kitti_length_key(length_m));
  for (const int share : kPathShares_percent) add(path_share_key(share));
  return any ? drift : Json(nullptr);
}

Json run_json(const Job& job, const Completion* completion, const ReportData& data) {
  const Plan& plan = data.plan;
  Json values = Json::array();
  std::map<std::string_view, double> known;
  if (completion != nullptr) known.insert(completion->metrics.begin(), completion->metrics.end());
  for (const std::string& key : plan.metrics) {
    const auto value = known.find(key);
    values.push_back(value == known.end() ? Json(nullptr) : Json(value->second));
  }
  Json run{{"repeat", job.repeat}, {"outcome", nullptr}, {"folder", nullptr}, {"report", false}};
  run["values"] = std::move(values);
  run["drift"] = drift_by_length(known);
  if (completion != nullptr) {
    run["outcome"] = name_of(completion->outcome);
    const std::string link = data.link(job);
    if (!link.empty()) run["folder"] = link;
    run["report"] = completion->has_report;
  }
  return run;
}

Json runs_json(const ReportData& data) {
  std::map<std::string, std::size_t> recordings;
  for (const PlannedRecording& recording : data.plan.recordings) {
    recordings.emplace(recording.name, recordings.size());
  }
  std::map<std::string, std::size_t> variants;
  for (const VariantSummary& variant : data.variants) {
    variants.emplace(variant.variant, variants.size());
  }
  Json list = Json::array();
  for (const Job& job : data.results.jobs()) {
    Json run = run_json(job, data.results.find(job), data);
    run["recording"] = recordings.at(job.recording);
    run["variant"] = variants.at(job.variant());
    list.push_back(std::move(run));
  }
  return list;
}

/// Accuracy and time of each, for the chart of both.
Json ranking_json(const Ranking& ranking) {
  Json list = Json::array();
  for (const RankedVariant& one : ranking.variants) {
    if (!one.mean || !one.wall_s) continue;
    list.push_back({{"name", one.variant},
                    {"value", *one.mean},
                    {"wall_s", *one.wall_s},
                    {"front", one.is_on_front}});
  }
  return list;
}

Json baseline_json(const BaselineComparison& baseline, const Plan& plan) {
  Json ok = Json::array();
  for (const OkChange& change : baseline.ok) {
    ok.push_back({{"variant", change.variant},
                  {"runs", change.runs},
                  {"before", change.before},
                  {"now", change.now},
                  {"verdict", name_of(change.verdict)}});
  }
  std::map<std::string, std::size_t> metrics;
  for (const std::string& key : plan.metrics) metrics.emplace(key, metrics.size());
  Json changes = Json::array();
  for (const Change& change : baseline.changes) {
    Json interval = nullptr;
    if (change.interval_percent) {
      interval = {change.interval_percent->first, change.interval_percent->second};
    }
    changes.push_back({{"variant", change.variant},
                       {"metric", metrics.at(change.metric)},
                       {"recordings", change.recordings},
                       {"before", change.before},
                       {"now", change.now},
                       {"percent", change.change_percent},
                       {"interval", std::move(interval)},
                       {"verdict", name_of(change.verdict)}});
  }
  return {{"ok", std::move(ok)}, {"changes", std::move(changes)}};
}

}  // namespace

std::string report_data_json(const ReportData& data, const std::optional<Ranking>& ranking) {
  Json json{{"metrics", metrics_json(data.plan)}};
  for (const PlannedRecording& recording : data.plan.recordings) {
    json["recordings"].push_back(recording.name);
  }
  for (const PlannedPipeline& pipeline : data.plan.pipelines) {
    json["pipelines"].push_back(pipeline.name);
  }
  json["lengths"] = {{"kitti_m", kKittiLengths_m}, {"share_percent", kPathShares_percent}};
  json["variants"] = variants_json(data);
  json["planned_variants"] = planned_variants_json(data.results);
  json["logs"] = data.is_of_a_batch();
  json["budgets"] = Json::array();
  for (const Budget& budget : data.plan.budgets) {
    json["budgets"].push_back({{"metric", budget.metric}, {"most", budget.most}});
  }
  json["runs"] = runs_json(data);
  json["ranking"] = ranking ? ranking_json(*ranking) : Json(nullptr);
  json["baseline"] = data.baseline ? baseline_json(*data.baseline, data.plan) : Json(nullptr);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace traverse::batch
