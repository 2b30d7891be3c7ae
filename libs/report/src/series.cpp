#include "series.hpp"

#include <algorithm>
#include <limits>

namespace traverse::report {

using evaluation::Comparison;
using evaluation::Relation;

const evaluation::Ape* find_ape(const Comparison& comparison, Relation relation) {
  const auto found = std::find_if(comparison.ape.begin(), comparison.ape.end(),
                                  [&](const auto& ape) { return ape.relation == relation; });
  return found == comparison.ape.end() ? nullptr : &*found;
}

const evaluation::Rpe* find_rpe(const Comparison& comparison, Relation relation, double frames) {
  const auto found =
      std::find_if(comparison.rpe.begin(), comparison.rpe.end(), [&](const auto& rpe) {
        return rpe.relation == relation &&
               rpe.options.delta.unit == evaluation::DeltaUnit::kFrames &&
               rpe.options.delta.value == frames;
      });
  return found == comparison.rpe.end() ? nullptr : &*found;
}

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
  std::vector<double> values(run.estimate.size(), std::numeric_limits<double>::quiet_NaN());
  const auto& matches = run.evaluation.comparison->association.matches;
  for (std::size_t k = 0; k < matches.size(); ++k) values[matches[k].estimate] = for_each_match[k];
  return values;
}

geometry::Trajectory aligned_estimate(const RunData& run) {
  if (!run.evaluation.comparison) return run.estimate;
  std::vector<geometry::Pose3> poses =
      evaluation::aligned(run.estimate.poses(), run.evaluation.comparison->alignment);
  return geometry::Trajectory::stamped(run.estimate.stamps(), std::move(poses));
}

Registration registration_of(const pipeline::FrameTable& frames) {
  Registration result;
  const std::vector<double> registered = frames.column("registered");
  for (std::size_t i = 1; i < registered.size(); ++i) result.lost += registered[i] == 0 ? 1 : 0;
  for (const double directions : frames.column("degenerate_directions")) {
    result.degenerate += directions > 0 ? 1 : 0;
  }
  return result;
}

std::size_t skipped_records(const nlohmann::json& record) {
  std::size_t total = 0;
  for (const auto& [reason, count] : record.at("frames").at("skipped").items()) {
    total += count.get<std::size_t>();
  }
  return total;
}

double percentile_of(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto rank =
      static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

}  // namespace traverse::report
