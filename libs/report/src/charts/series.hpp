#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "traverse/evaluation/evaluate.hpp"

#include "run/run_data.hpp"

/// Series of a run that several parts of its report need.
namespace traverse::report {

/// No value: a gap in a line, a dash in a table.
inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Seconds from the first pose of the estimate to each.
std::vector<double> seconds_from_start(const RunData& run);
/// The same of the poses that have a partner on the reference.
std::vector<double> match_times(const RunData& run);
/// One value a pose of the estimate, of one a match; NaN where a pose found no partner.
std::vector<double> for_each_pose(const RunData& run, const std::vector<double>& for_each_match);

/// The estimate brought onto the reference as the evaluation did, to be drawn over it.
geometry::Trajectory aligned_estimate(const RunData& run);

/// A place of the map as aligned_estimate() has it.
Eigen::Vector3d aligned_place(const RunData& run, const Eigen::Vector3d& p_map);

/// Unit vector to true north in the map frame of the estimate; nothing where it is not known.
std::optional<Eigen::Vector3d> north_of_map(const RunData& run);
/// The same in the frame of aligned_estimate().
std::optional<Eigen::Vector3d> north_of_reference(const RunData& run);

std::size_t skipped_records(const nlohmann::json& record);

/// statistics::quantile(); NaN without values.
double quantile_or_none(const std::vector<double>& values, double share);

}  // namespace traverse::report
