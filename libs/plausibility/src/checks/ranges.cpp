#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "traverse/sensors/lidar_profile.hpp"
#include "traverse/statistics/quantile.hpp"

#include "checks/check.hpp"

namespace traverse::plausibility {

namespace {

// No lidar for vehicles sees farther than a few hundred metres, and few things are nearer than half
// a metre; half of what one sees is within tens of metres.
constexpr double kFarthestReturn_m = 600;

constexpr std::array<CodeMeaning, 6> kRangeCodes{{
    {"points_absurd",
     "Coordinates beyond 10 000 km, or below a micrometre and not zero, of a "
     "twentieth of the points: bytes that are no coordinates (64-bit numbers read as "
     "32-bit ones, columns that were not counted)."},
    {"points_far_away",
     "Points whose middle is farther than 600 m while they lie within 600 m of it: "
     "coordinates of a map, not of the sensor."},
    {"points_in_millimetres",
     "Half of the ranges beyond 600 m, or, in a thousandth, within what the "
     "profile says: millimetres."},
    {"points_out_of_range", "Fewer than a tenth of the points within the profile's ranges."},
    {"points_missing",
     "Fewer than a twentieth of the points are somewhere: the others are not finite "
     "or zero."},
    {"points_columns",
     "The numbers of a scan in the order in which they are stored: neighbours in "
     "space stand one point apart. Where they are much more alike at another "
     "distance than four numbers, points have another number of columns."},
}};

/// Of the scans' values the median.
template <typename Value>
double median_of(const std::vector<ScanSummary>& scans, const Value& value) {
  std::vector<double> values;
  for (const ScanSummary& scan : scans) values.push_back(value(scan));
  return statistics::median(values);
}

double share(std::size_t part, std::size_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
}

void look_at_ranges(const View& view, std::vector<Finding>& findings) {
  const Evidence& evidence = view.evidence;
  for (const auto& [label, track] : evidence.lidars) {
    const std::vector<ScanSummary>& scans = track.scans();
    if (scans.empty()) continue;
    const auto* mounted = evidence.recording.rig.find(label);
    const sensors::LidarProfile profile =
        mounted != nullptr && mounted->lidar ? *mounted->lidar : sensors::LidarProfile();
    const double absurd = median_of(
        scans, [](const ScanSummary& s) { return share(s.absurd, s.looked_at - s.at_origin); });
    const double columns =
        median_of(scans, [](const ScanSummary& s) { return static_cast<double>(s.columns); });
    const bool is_bin = evidence.recording.format.starts_with("KITTI");
    const std::string columns_statement =
        columns != 0 && columns != 4 ? fmt::format("--recording bin.columns={:.0f}", columns) : "";
    if (absurd > 0.05) {
      findings.push_back(
          {"points_absurd", Severity::kRefuse, label,
           fmt::format("{:.0f} % of the points have a coordinate beyond 10 000 km or below a "
                       "micrometre",
                       100 * absurd),
           is_bin
               ? "The files hold no points of four 32-bit numbers x y z intensity; 64-bit numbers, "
                 "perhaps"
               : "The files do not hold what their header says",
           is_bin ? "--recording bin.type=float64" : ""});
      continue;
    }
    if (is_bin && columns != 0 && columns != 4) {
      findings.push_back(
          {"points_columns", Severity::kRefuse, label,
           fmt::format("successive numbers repeat after {:.0f} numbers, not after 4: points have "
                       "{:.0f} columns",
                       columns, columns),
           "Coordinates would be taken for each other", columns_statement});
      continue;
    }
    const double missing = median_of(
        scans, [](const ScanSummary& s) { return share(s.not_finite + s.at_origin, s.looked_at); });
    if (missing > 0.95) {
      findings.push_back(
          {"points_missing",
           Severity::kWarn,
           label,
           fmt::format("{:.1f} % of the points of a scan are not finite or zero", 100 * missing),
           "There is little to register on",
           {}});
    }
    const double range = median_of(scans, [](const ScanSummary& s) { return s.range_median_m; });
    const double spread = median_of(scans, [](const ScanSummary& s) { return s.spread_m; });
    const double centre = median_of(scans, [](const ScanSummary& s) { return s.centre.norm(); });
    if (centre > kFarthestReturn_m && spread < kFarthestReturn_m) {
      findings.push_back(
          {"points_far_away",
           Severity::kRefuse,
           label,
           fmt::format("the points lie within {:.3g} m of a place that is {:.4g} m from "
                       "the sensor",
                       spread, centre),
           "Coordinates of a map (UTM?) are no scans: ranges, rings and times cannot be "
           "told from them, and 32-bit numbers hold them to decimetres",
           {}});
      continue;
    }
    const bool is_far = range > kFarthestReturn_m;
    if (is_far && range / 1000 < kFarthestReturn_m) {
      const bool is_centimetres = range / 1000 < profile.min_range_m;
      findings.push_back(
          {"points_in_millimetres", Severity::kRefuse, label,
           fmt::format("half of the ranges are beyond {:.4g} m; a few tens expected", range),
           "Nothing would be within the sensor's reach",
           is_centimetres ? "--recording point_unit_m=0.01" : "--recording point_unit_m=0.001"});
      continue;
    }
    const double outside = median_of(scans, [&](const ScanSummary& s) {
      const bool is_short = s.range_p95_m < profile.min_range_m;
      const bool is_long = s.range_p05_m > profile.max_range_m;
      return is_short || is_long ? 1.0 : 0.0;
    });
    if (outside > 0.5) {
      const double p95 = median_of(scans, [](const ScanSummary& s) { return s.range_p95_m; });
      findings.push_back(
          {"points_out_of_range", Severity::kRefuse, label,
           fmt::format(
               "nineteen of twenty ranges are {} (median {:.3g} m, {:.3g} m at 95 %); {:g} to "
               "{:g} m are used",
               p95 < profile.min_range_m ? "too small" : "too large", range, p95,
               profile.min_range_m, profile.max_range_m),
           "No point would be used",
           "--recording point_unit_m=..., lidar.min_range_m=... or "
           "lidar.max_range_m=..."});
    }
  }
}

}  // namespace

const Check kRanges{kRangeCodes, look_at_ranges};

}  // namespace traverse::plausibility
