#include "charts/navigation_charts.hpp"

#include <string>
#include <vector>

#include "charts/chart.hpp"
#include "charts/navigation_series.hpp"

namespace traverse::report {

namespace {

constexpr const char* kSection = "navigation";

void add_innovations(const pipeline::FrameTable& frames, Json& charts) {
  Chart chart("nis", kSection, "Chi-square of each factor over its rows (NIS)", "");
  chart.flag("log").flag("points").level("expected mean", 1);
  for (const auto& [prefix, name] : kInnovationKinds) {
    const auto values = innovations(frames, prefix);
    if (has_any(values)) chart.series(name, values);
  }
  charts.push_back(chart.take());
}

void add_fixes(const pipeline::FrameTable& frames, Json& charts) {
  for (const bool are_rejected : {false, true}) {
    Chart chart(are_rejected ? "fixes-rejected" : "fixes", kSection,
                are_rejected ? "Prediction less fix, those that were rejected"
                             : "Prediction less fix, those that were taken",
                "m");
    chart.flag("points");
    bool any = false;
    for (const char* direction : {"east", "north", "up"}) {
      const auto values = fix_residuals(frames, direction, are_rejected);
      any = any || has_any(values);
      chart.series(direction, values);
    }
    if (any) charts.push_back(chart.take());
  }
}

void add_estimated(const char* id, const char* title, const char* unit,
                   const std::vector<Estimated>& all, Json& charts) {
  Chart chart(id, kSection, std::string(title) + ", with 3 sigma", unit);
  for (const Estimated& one : all) chart.series(one.name, one.values, one.three_sigma);
  if (!all.empty() && !all.front().values.empty()) charts.push_back(chart.take());
}

}  // namespace

void add_navigation_charts(const RunData& run, Json& charts) {
  const pipeline::FrameTable& frames = run.frames;
  add_innovations(frames, charts);
  add_fixes(frames, charts);
  add_estimated("gyro-bias", "Bias of the gyro less its end", "rad/s",
                bias_axes(frames, "gyro", "rad_s"), charts);
  add_estimated("accelerometer-bias", "Bias of the accelerometer less its end", "m/s²",
                bias_axes(frames, "accelerometer", "m_s2"), charts);
  add_estimated("wheel-scale", "Scale of the wheels less its end", "%",
                {less_its_end(estimated(frames, "scale", "wheel_scale", "wheel_scale_sigma"), 100)},
                charts);
  add_estimated("wheel-turn", "Turn of the wheels' axes", "deg",
                {estimated(frames, "pitch", "wheel_pitch_deg", "wheel_pitch_sigma"),
                 estimated(frames, "yaw", "wheel_yaw_deg", "wheel_yaw_sigma")},
                charts);
  add_estimated("gnss-latency", "Latency of the fixes", "s",
                {estimated(frames, "latency", "gnss_latency_s", "gnss_latency_sigma")}, charts);
  add_estimated("gnss-bias", "Slowly varying error of fixes", "m",
                {estimated(frames, "east", "gnss_bias_east_m", "gnss_bias_east_sigma"),
                 estimated(frames, "north", "gnss_bias_north_m", "gnss_bias_north_sigma"),
                 estimated(frames, "up", "gnss_bias_up_m", "gnss_bias_up_sigma")},
                charts);
}

}  // namespace traverse::report
