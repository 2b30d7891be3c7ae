#include "figures/navigation_figures.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "traverse/render/pictures/time_series.hpp"

#include "charts/navigation_series.hpp"
#include "charts/series.hpp"

namespace traverse::report {

namespace {

using render::Style;

/// Panels over the times of frames; what a moment does not have is left out, so that what is rare
/// is no gap.
class Panels {
 public:
  explicit Panels(const RunData& run) : times_(seconds_from_start(run)) {
    const auto outages = spans_where(times_, run.frames.column("in_outage"));
    if (!outages.empty()) series_.shaded.push_back({"without GNSS", outages});
  }

  void begin(std::string name, std::string unit) {
    series_.panels.push_back({std::move(name), std::move(unit), {}, {}});
  }
  void level(double value, std::string label) {
    series_.panels.back().level = {value, std::move(label)};
  }
  /// A line of the last panel.
  void add(std::string name, const std::vector<double>& values) {
    auto& [x, y] = kept_.emplace_back();
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!std::isfinite(values[i])) continue;
      x.push_back(times_[i]);
      y.push_back(values[i]);
    }
    series_.panels.back().series.push_back({std::move(name), x, y});
  }
  void shade(std::string name, const std::vector<double>& flags) {
    const auto spans = spans_where(times_, flags);
    if (!spans.empty()) series_.shaded.push_back({std::move(name), spans});
  }
  const render::TimeSeries& series() const { return series_; }

 private:
  std::vector<double> times_;
  std::deque<std::pair<std::vector<double>, std::vector<double>>> kept_;
  render::TimeSeries series_;
};

void draw(const Panels& panels, const char* name, const char* title, const char* text,
          const std::string& statistic, FigureMaker& maker) {
  if (panels.series().panels.empty()) return;
  maker.add(
      "navigation", name, text,
      [&](const Style& style) {
        return render::time_series(panels.series(), maker.caption(title, statistic), style);
      },
      "charts");
}

void add_innovations(const RunData& run, FigureMaker& maker) {
  Panels panels(run);
  for (const auto& [prefix, name] : kInnovationKinds) {
    const auto values = innovations(run.frames, prefix);
    if (!has_any(values)) continue;
    panels.begin(name, "");
    panels.add("", values);
    panels.level(1, "expected mean");
  }
  draw(panels, "navigation-nis", "Chi-square over rows (NIS)",
       "How well each kind of factor agreed with what was predicted: chi-square over its rows, "
       "whose mean is 1 where the covariances are right.",
       fmt::format("{} frames", run.frames.rows().size()), maker);
}

void add_fixes(const RunData& run, FigureMaker& maker) {
  Panels panels(run);
  std::size_t rejections = 0;
  const auto rejected = run.frames.column("gnss_rejected");
  for (const double flag : rejected) rejections += flag != 0 ? 1 : 0;
  for (const char* direction : {"east", "north", "up"}) {
    const auto values = fix_residuals(run.frames, direction, false);
    if (!has_any(values)) return;
    panels.begin(direction, "m");
    panels.add("", values);
  }
  panels.shade("rejected", rejected);
  draw(panels, "navigation-fixes", "Prediction less fix",
       "How far each fix that was taken was from what was predicted; fixes that were rejected are "
       "marked.",
       fmt::format("{} rejected", rejections), maker);
}

void add_biases(const RunData& run, const char* name, const char* title, const char* unit,
                const std::vector<Estimated>& axes, FigureMaker& maker) {
  Panels panels(run);
  for (const Estimated& axis : axes) {
    std::vector<double> above = axis.values;
    std::vector<double> below = axis.values;
    for (std::size_t i = 0; i < axis.values.size(); ++i) {
      above[i] += axis.three_sigma[i];
      below[i] -= axis.three_sigma[i];
    }
    panels.begin(axis.name, unit);
    panels.add("bias", axis.values);
    panels.add("+3 sigma", above);
    panels.add("-3 sigma", below);
  }
  draw(panels, name, title,
       "The bias of each axis less what it is at the end, and three standard deviations to both "
       "sides.",
       "less the value at the end", maker);
}

}  // namespace

std::vector<render::Range> spans_where(const std::vector<double>& times,
                                       const std::vector<double>& flags) {
  std::vector<render::Range> spans;
  const std::size_t count = std::min(times.size(), flags.size());
  for (std::size_t i = 0; i < count; ++i) {
    if (flags[i] == 0) continue;
    const double before = i > 0 ? (times[i] - times[i - 1]) / 2 : 0;
    const double after = i + 1 < count ? (times[i + 1] - times[i]) / 2 : 0;
    if (i > 0 && flags[i - 1] != 0) {
      spans.back().high = times[i] + after;
    } else {
      spans.push_back({times[i] - before, times[i] + after});
    }
  }
  return spans;
}

void add_navigation_figures(const RunData& run, FigureMaker& maker) {
  if (run.frames.rows().size() < 2) return;
  add_innovations(run, maker);
  add_fixes(run, maker);
  add_biases(run, "navigation-gyro-bias", "Bias of the gyro", "rad/s",
             bias_axes(run.frames, "gyro", "rad_s"), maker);
  add_biases(run, "navigation-accelerometer-bias", "Bias of the accelerometer", "m/s²",
             bias_axes(run.frames, "accelerometer", "m_s2"), maker);
}

}  // namespace traverse::report
