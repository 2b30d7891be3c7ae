#pragma once

#include <string>

#include "results/ranking.hpp"
#include "results/report.hpp"

namespace traverse::batch {

/// The numbers that the page's scripts draw from, as JSON.
///
/// {
///   "metrics": [{"key", "title", "unit", "lower", "higher"}],
///   "recordings": [NAME], "pipelines": [NAME],
///   "lengths": {"kitti_m": [], "share_percent": []},
///   "variants": [{"name", "pipeline", "settings": ["key=value"], "runs", "ok", "over_budget",
///                 "means": [a metric], "kitti": null | {"segments", "translation" | "rotation":
///                 {"all_segments", "per_recording"}}}],          best first
///   "planned_variants": [["key=value"]],                         in the order of the plan
///   "logs": whether runs have a log.txt,
///   "budgets": [{"metric", "most"}],
///   "runs": [{"recording", "variant": indices, "repeat", "outcome": null | NAME, "values": [a
///             metric], "drift": null | [of lengths, those of kitti_m first],
///             "folder": null | PATH, "report"}],        in the order of the plan
///   "baseline": null | {"ok": [{"variant", "runs", "before", "now", "verdict"}],
///                       "changes": [{"variant", "metric": index, "recordings", "before", "now",
///                                    "percent", "interval": null | [low, high], "verdict"}]},
///   "ranking": null | [{"name", "value": of the first metric, "wall_s", "front"}]
/// }
std::string report_data_json(const ReportData& data, const std::optional<Ranking>& ranking);

}  // namespace traverse::batch
