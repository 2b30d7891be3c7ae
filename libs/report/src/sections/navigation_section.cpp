#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "charts/navigation_series.hpp"
#include "run/number_texts.hpp"
#include "sections/sections.hpp"

namespace traverse::report {

namespace {

/// How well a factor kind agreed with the estimate: its normalised innovation squared over its
/// degrees of freedom should be 1 on average.
Table innovations_table(const pipeline::FrameTable& frames) {
  Table table("innovations", "Agreement of the factors",
              {"factor", "times", "mean chi-square / rows", "largest", "rejected"});
  for (const auto& [column, name] : kInnovationKinds) {
    const std::string prefix = column;
    const auto chi2 = frames.column(prefix + "_chi2");
    const auto rows = frames.column(prefix + "_rows");
    const auto rejected = frames.column(prefix + "_rejected");
    std::size_t times = 0;
    std::size_t rejections = 0;
    double sum = 0;
    double largest = 0;
    for (std::size_t i = 0; i < chi2.size(); ++i) {
      if (rows[i] == 0) continue;
      ++times;
      rejections += rejected[i] != 0 ? 1 : 0;
      if (rejected[i] == 0) sum += chi2[i] / rows[i];
      largest = std::max(largest, chi2[i] / rows[i]);
    }
    if (times == 0) continue;
    const auto taken = static_cast<double>(std::max<std::size_t>(1, times - rejections));
    table.add_row({name, Cell::count(times), sum / taken, largest, Cell::count(rejections)});
  }
  return table;
}

Table biases_table(const pipeline::FrameTable& frames) {
  Table table("biases", "Biases and what else is estimated",
              {"bias", "at the end", "3 sigma", "3 sigma at the beginning"});
  const auto add = [&](const std::string& name, const std::string& value,
                       const std::string& deviation) {
    const auto values = frames.column(value);
    const auto sigma = frames.column(deviation);
    if (!values.empty()) {
      table.add_row({name, values.back(), 3 * sigma.back(), 3 * sigma.front()});
    }
  };
  for (const std::string axis : {"x", "y", "z"}) {
    add("gyro " + axis + " [rad/s]", "gyro_bias_" + axis + "_rad_s",
        "gyro_bias_" + axis + "_sigma");
  }
  for (const std::string axis : {"x", "y", "z"}) {
    add("accelerometer " + axis + " [m/s²]", "accelerometer_bias_" + axis + "_m_s2",
        "accelerometer_bias_" + axis + "_sigma");
  }
  add("wheel scale", "wheel_scale", "wheel_scale_sigma");
  add("pitch of the wheels' axes [deg]", "wheel_pitch_deg", "wheel_pitch_sigma");
  add("yaw of the wheels' axes [deg]", "wheel_yaw_deg", "wheel_yaw_sigma");
  add("latency of the fixes [s]", "gnss_latency_s", "gnss_latency_sigma");
  for (const std::string direction : {"east", "north", "up"}) {
    add("fixes, " + direction + " [m]", "gnss_bias_" + direction + "_m",
        "gnss_bias_" + direction + "_sigma");
  }
  return table;
}

Table outages_table(const pipeline::FrameTable& frames) {
  Table table("outages", "GNSS outages",
              {"outage ended at [s]", "distance [m]", "error [m]", "of the distance [%]"});
  const auto stamp = frames.column("stamp_s");
  const auto error = frames.column("outage_error_m");
  const auto distance = frames.column("outage_distance_m");
  for (std::size_t i = 0; i < error.size(); ++i) {
    if (distance[i] <= 0) continue;
    table.add_row({stamp[i] - stamp.front(), distance[i], error[i], 100 * error[i] / distance[i]});
  }
  return table;
}

}  // namespace

bool is_navigation_run(const RunData& run) { return is_navigation(run.frames); }

void add_navigation(const RunData& run, Model& model) {
  model.add_table(innovations_table(run.frames));
  model.add_table(biases_table(run.frames));
  model.add_table(outages_table(run.frames));
}

}  // namespace traverse::report
