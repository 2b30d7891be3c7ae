#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "traverse/statistics/quantile.hpp"

#include "checks/check.hpp"

namespace traverse::plausibility {

namespace {

// A lidar measures all the time: a sweep takes as long as there is from one scan to the next, and
// less where scans were left out. More than that cannot be, and a hundredth is another unit: units
// of time are a thousand apart, and nobody keeps one scan of a hundred.
constexpr std::array<CodeMeaning, 3> kTimesCodes{{
    {"point_times_short",
     "The span of a scan's stored point times, in the median, against the time to "
     "the next scan: less than a hundredth."},
    {"point_times_long", "The same, more than 1.5 times."},
    {"point_times_equal", "Scans all of whose points have one time, where most scans have not."},
}};

void look_at_times(const View& view, std::vector<Finding>& findings) {
  const Evidence& evidence = view.evidence;
  constexpr std::size_t kMinScans = 3;
  for (const auto& [label, track] : evidence.lidars) {
    const auto interval = track.interval_s();
    std::vector<double> spans;
    std::size_t equal = 0;
    for (const ScanSummary& scan : track.scans()) {
      if (!scan.times_s) continue;
      const double span = (*scan.times_s)[1] - (*scan.times_s)[0];
      if (span == 0) ++equal;
      spans.push_back(span);
    }
    if (!interval || spans.size() < kMinScans || evidence.recording.motion_compensated) continue;
    const double span = statistics::median(spans);
    if (span == 0) continue;
    if (equal > 0) {
      findings.push_back(
          {"point_times_equal",
           Severity::kWarn,
           label,
           fmt::format("{} of {} scans have one time for all points; {:.4g} s from first "
                       "to last in the others",
                       equal, spans.size(), span),
           "Such a scan cannot be deskewed",
           {}});
    }
    const double share = span / *interval;
    if (share > 0.01 && share < 1.5) continue;
    const bool is_short = share <= 0.01;
    const bool is_stated_there = evidence.recording.format == "point-cloud folder";
    findings.push_back(
        {is_short ? "point_times_short" : "point_times_long",
         share > 10 ? Severity::kRefuse : Severity::kWarn, label,
         fmt::format("the point times of a scan span {:.4g} s, and scans are {:.4g} s apart", span,
                     *interval),
         is_short ? "Scans would hardly be deskewed" : "Scans would be torn apart by the deskew",
         is_stated_there ? "--recording point_time_unit_s=..."
                         : "--recording lidar.time_source=none"});
  }
}

}  // namespace

const Check kPointTimes{kTimesCodes, look_at_times};

}  // namespace traverse::plausibility
