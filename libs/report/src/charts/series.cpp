#include "charts/series.hpp"

#include <algorithm>

#include "traverse/statistics/quantile.hpp"

namespace traverse::report {

std::vector<double> seconds_from_start(const RunData& run) {
  std::vector<double> seconds;
  for (const auto stamp : run.estimate.stamps()) {
    seconds.push_back(geometry::seconds_between(run.estimate.stamps().front(), stamp));
  }
  return seconds;
}

std::vector<double> match_times(const RunData& run) {
  std::vector<double> seconds;
  for (const auto stamp : run.evaluation.comparison->stamps) {
    seconds.push_back(geometry::seconds_between(run.estimate.stamps().front(), stamp));
  }
  return seconds;
}

std::vector<double> for_each_pose(const RunData& run, const std::vector<double>& for_each_match) {
  std::vector<double> values(run.estimate.size(), kNone);
  const auto& matches = run.evaluation.comparison->association.matches;
  for (std::size_t k = 0; k < matches.size(); ++k) values[matches[k].estimate] = for_each_match[k];
  return values;
}

geometry::Trajectory aligned_estimate(const RunData& run) {
  if (!run.evaluation.comparison) return run.estimate;
  const evaluation::Poses poses =
      evaluation::aligned(run.estimate.poses(), run.evaluation.comparison->alignment);
  return geometry::Trajectory::stamped(run.estimate.stamps(), to_vector(poses));
}

Eigen::Vector3d aligned_place(const RunData& run, const Eigen::Vector3d& p_map) {
  if (!run.evaluation.comparison) return p_map;
  const evaluation::Alignment& alignment = run.evaluation.comparison->alignment;
  return alignment.T_reference_estimate * Eigen::Vector3d(alignment.scale * p_map);
}

std::optional<Eigen::Vector3d> north_of_map(const RunData& run) {
  const auto north = run.record.at("map").find("north");
  if (north == run.record.at("map").end() || north->is_null()) return std::nullopt;
  return Eigen::Vector3d(north->at(0), north->at(1), north->at(2));
}

std::optional<Eigen::Vector3d> north_of_reference(const RunData& run) {
  const auto north = north_of_map(run);
  if (!north || !run.evaluation.comparison) return north;
  return run.evaluation.comparison->alignment.T_reference_estimate.rotation * *north;
}

std::size_t skipped_records(const nlohmann::json& record) {
  std::size_t total = 0;
  for (const auto& [reason, count] : record.at("frames").at("skipped").items()) {
    total += count.get<std::size_t>();
  }
  return total;
}

double quantile_or_none(const std::vector<double>& values, double share) {
  if (values.empty()) return kNone;
  return statistics::quantile(values, share);
}

}  // namespace traverse::report
