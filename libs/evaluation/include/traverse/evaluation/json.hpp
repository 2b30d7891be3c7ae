#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <string_view>

#include "traverse/evaluation/evaluate.hpp"

namespace traverse::evaluation {

/// evaluation.json: every figure with how it was made and the values behind it. Numbers are the
/// shortest text that reads back to the same bits; what is not defined is null, never NaN.
///
/// {
///   "estimate": {"name", "poses", "path_m", "first_stamp_ns", "last_stamp_ns", "read_as": null |
///                TEXT, "notes": []},
///   "reference": the same | null,
///   "association": null | {"by": "stamp|index", "pairs", "max_time_difference", "time_offset",
///                          "largest_time_difference", "how",
///                          "per_pair": {"estimate": [], "reference": [], "time_difference_s": [],
///                                       "stamp_ns": [] | null, "distance_m": []}},
///   "alignment": null | {"mode", "scale", "T_reference_estimate": 4x4, "poses_used",
///                        "undetermined": "nothing|rotation about the line|rotation|...",
///                        "reason": null | TEXT, "how"},
///   "ape": {RELATION: STATS + {"unit", "how", "per_pair": {"value": []}}},
///   "ape_at_origin": the same, only where something of the alignment is undetermined,
///   "split": null | {"along": PART, "across": PART, "up": PART, "unit": "m", "poses",
///                    "alternating_m": null | number, "how"},
///   "rpe": [{"delta", "unit": "f|m|deg|rad", "all_pairs", "pairs_from", "relation", "stats":
///   STATS,
///            "relation_unit", "dropped_without_motion", "how",
///            "per_pair": {"from": [], "to": [], "value": []}}],
///   "kitti": null | {"frame", "T_body_camera": null | 4x4, "segments", "translation_percent",
///                    "rotation_deg_per_m",
///                    "by_length": [{"length_m", "segments", "translation_percent",
///                                   "rotation_deg_per_m"}],
///                    "by_speed": [{"speed_mps", ...}], "step", "frame_seconds", "how",
///                    "per_segment": {"first": [], "last": [], "length_m": [],
///                                    "translation_percent": [], "rotation_deg_per_m": [],
///                                    "speed_mps": []}},
///   "sub_trajectories": null | {"lengths": [{"length_m", "translation_m": STATS,
///                               "translation_percent", "rotation_deg", "rotation_deg_per_m",
///                               "yaw_deg", "gravity_deg"}], "how"},
///   "path": {"estimate_m", "reference_m", "end_error_m", "end_error_percent", "end_rotation_deg",
///            "how"},
///   "consistency": null | {"mme", "mpv_m", "queries", "scans", "points", "points_are", "how",
///                          "point_to_plane": null | {"queries", "mean_m", "median_m", "p90_m"}},
///   "undefined": [{"metric", "reason"}],
///   "warnings": []
/// }
/// STATS: {"rmse", "mean", "median", "std", "min", "max", "sse", "count"}; PART: {"rmse", "mean",
/// "max"}. Files from before version 0.2 have no "split" and
/// no "sub_trajectories". Times are seconds,
/// stamps whole nanoseconds; indices in rpe and kitti count the elements of association.per_pair.
std::string to_json(const Evaluation& evaluation);

/// The same into a stream, without the whole of it in memory.
void write_json(const Evaluation& evaluation, std::ostream& stream);

/// Reads it back; to_json() of the result is `text` again.
/// \throws EvaluationError naming the key that is missing or of another kind.
Evaluation from_json(std::string_view text);
/// The same of a file. \throws files::InputError naming the file and the key.
Evaluation read_evaluation(const std::filesystem::path& file);

}  // namespace traverse::evaluation
