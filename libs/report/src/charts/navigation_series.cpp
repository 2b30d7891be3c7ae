#include "charts/navigation_series.hpp"

#include <algorithm>
#include <cmath>

#include "charts/series.hpp"

namespace traverse::report {

std::vector<double> innovations(const pipeline::FrameTable& frames, const std::string& prefix) {
  std::vector<double> values = frames.column(prefix + "_chi2");
  const auto rows = frames.column(prefix + "_rows");
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = rows[i] > 0 ? values[i] / rows[i] : kNone;
  }
  return values;
}

std::vector<double> fix_residuals(const pipeline::FrameTable& frames, const std::string& direction,
                                  bool are_rejected) {
  std::vector<double> values = frames.column("gnss_residual_" + direction + "_m");
  const auto rows = frames.column("gnss_rows");
  const auto rejected = frames.column("gnss_rejected");
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (rows[i] == 0 || (rejected[i] != 0) != are_rejected) values[i] = kNone;
  }
  return values;
}

Estimated estimated(const pipeline::FrameTable& frames, std::string name, const std::string& column,
                    const std::string& sigma) {
  Estimated result{std::move(name), frames.column(column), frames.column(sigma)};
  for (double& deviation : result.three_sigma) deviation *= 3;
  return result;
}

Estimated less_its_end(Estimated one, double factor) {
  const double end = one.values.empty() ? 0 : one.values.back();
  for (double& value : one.values) value = factor * (value - end);
  for (double& deviation : one.three_sigma) deviation *= factor;
  return one;
}

std::vector<Estimated> bias_axes(const pipeline::FrameTable& frames, const std::string& sensor,
                                 const std::string& unit) {
  std::vector<Estimated> axes;
  for (const std::string axis : {"x", "y", "z"}) {
    const std::string bias = sensor + "_bias_" + axis;
    axes.push_back(less_its_end(estimated(frames, axis, bias + "_" + unit, bias + "_sigma")));
  }
  return axes;
}

std::vector<double> at_fixes(const pipeline::FrameTable& frames, const std::string& column) {
  if (!frames.has(column)) return {};
  std::vector<double> values = frames.column(column);
  const auto by_gnss = frames.column("by_gnss");
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (by_gnss[i] == 0 || values[i] < 0) values[i] = kNone;
  }
  return values;
}

PlacedFixes placed_fixes(const pipeline::FrameTable& frames) {
  PlacedFixes fixes;
  if (!frames.has("fix_east_m")) return fixes;
  const auto east = frames.column("fix_east_m");
  const auto north = frames.column("fix_north_m");
  const auto up = frames.column("fix_up_m");
  const auto rows = frames.column("gnss_rows");
  const auto rejected = frames.column("gnss_rejected");
  for (std::size_t i = 0; i < east.size(); ++i) {
    if (rows[i] == 0) continue;
    (rejected[i] != 0 ? fixes.rejected : fixes.taken).emplace_back(east[i], north[i], up[i]);
  }
  return fixes;
}

bool has_any(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

bool is_navigation(const pipeline::FrameTable& frames) { return frames.has("inertial_chi2"); }

}  // namespace traverse::report
