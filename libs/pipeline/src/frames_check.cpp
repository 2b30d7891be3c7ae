#include "frames_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"
#include "traverse/files/numbers.hpp"

namespace traverse::pipeline {

namespace {

using files::InputError;
using files::Place;

constexpr double kSameStamp_s = 1e-6;  // a double holds today's stamps to a quarter of it
constexpr double kMostCounted = 1e15;
constexpr double kMostMilliseconds = 1e12;
constexpr double kSameTime = 1e-6;  // relative: sums of the same numbers

/// Columns that are read together: who has the first has the others.
const std::vector<std::vector<std::string>>& column_groups() {
  static const std::vector<std::vector<std::string>> kGroups = [] {
    std::vector<std::vector<std::string>> groups{
        {"residual_rms_m", "registered", "degenerate_directions", "inlier_share", "line_matches",
         "plane_matches", "eigenvalue_1"},
        {"eigenvalue_1", "degenerate_directions", "inlier_share"},
        {"inertial_chi2", "gnss_rows", "gnss_rejected"},
        {"outage_error_m", "outage_distance_m"},
        {"correction_m", "roughness_m", "by_gnss", "fix_east_m", "fix_north_m", "fix_up_m",
         "gnss_rows", "gnss_rejected"},
        {"wheel_scale", "wheel_scale_sigma"},
        {"wheel_pitch_deg", "wheel_pitch_sigma"},
        {"wheel_yaw_deg", "wheel_yaw_sigma"},
        {"gnss_latency_s", "gnss_latency_sigma"}};
    std::vector<std::string> covariance;
    const std::vector<std::string> twist{"rx", "ry", "rz", "tx", "ty", "tz"};
    for (auto row = twist.begin(); row != twist.end(); ++row) {
      for (auto col = row; col != twist.end(); ++col) {
        covariance.push_back("covariance_" + *row + "_" + *col);
      }
    }
    groups.push_back(covariance);
    for (const std::string kind : {"gnss", "heading", "wheels", "standing", "inertial"}) {
      groups.push_back({kind + "_chi2", kind + "_rows", kind + "_rejected"});
    }
    for (const std::string direction : {"east", "north", "up"}) {
      groups.push_back({"gnss_residual_" + direction + "_m", "gnss_rows", "gnss_rejected"});
      groups.push_back({"gnss_bias_" + direction + "_m", "gnss_bias_" + direction + "_sigma"});
    }
    for (const std::string axis : {"x", "y", "z"}) {
      groups.push_back({"gyro_bias_" + axis + "_rad_s", "gyro_bias_" + axis + "_sigma"});
      groups.push_back(
          {"accelerometer_bias_" + axis + "_m_s2", "accelerometer_bias_" + axis + "_sigma"});
    }
    return groups;
  }();
  return kGroups;
}

constexpr std::array<const char*, 6> kCounts{
    "registered", "degenerate_directions", "line_matches", "plane_matches", "keyframe", "loops"};

class FramesCheck {
 public:
  FramesCheck(const FrameTable& frames, const RunFolder& folder)
      : frames_(frames), file_(folder.frames()) {}

  void require_columns(bool has_times) const {
    for (const char* name : {"frame", "stamp_s"}) require_column(name);
    if (has_times) require_column("total_ms");
    for (const auto& group : column_groups()) {
      if (!frames_.has(group.front())) continue;
      for (const std::string& name : group) require_column(name);
    }
    // Readers take frame and stamp for the first and the total for the last.
    const auto& columns = frames_.columns();
    const bool ends_so = (columns.back() == "total_ms") == has_times;
    if (columns[0] == "frame" && columns[1] == "stamp_s" && ends_so) return;
    throw InputError(
        file_, Place::line(1),
        fmt::format("the columns frame, stamp_s, ...{}", has_times ? ", total_ms" : ""),
        "another order");
  }

  void require_rows(std::size_t poses) const {
    if (frames_.rows().size() == poses) return;
    throw InputError(file_, Place::whole_file(),
                     fmt::format("{} rows, one for each pose of trajectory.tum", poses),
                     std::to_string(frames_.rows().size()));
  }

  /// \param expected of a row, and what it is called
  template <typename Expected>
  void require_values(const char* column, double tolerance, const std::string& what,
                      const Expected& expected) const {
    const std::vector<double> values = frames_.column(column);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (std::abs(values[i] - expected(i)) <= tolerance) continue;
      throw error(i, column, fmt::format("{}, {}", what, files::to_text(expected(i))), values[i]);
    }
  }

  void require_within(const std::string& column, double most, bool is_whole) const {
    const std::vector<double> values = frames_.column(column);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double value = values[i];
      if (value >= 0 && value <= most && (!is_whole || value == std::floor(value))) continue;
      throw error(i, column, is_whole ? "a count" : fmt::format("a number from 0 to {}", most),
                  value);
    }
  }

 private:
  void require_column(const std::string& name) const {
    if (frames_.has(name)) return;
    throw InputError(file_, Place::line(1), "a column " + name, "none");
  }
  InputError error(std::size_t row, const std::string& column, const std::string& expected,
                   double found) const {
    return {
        file_, {fmt::format("row {}, column {}", row, column)}, expected, files::to_text(found)};
  }

  const FrameTable& frames_;
  std::filesystem::path file_;
};

/// That run.json is of these frames: their number, and what their times sum up to.
void require_record_of(const FrameTable& frames, const files::JsonValue& record) {
  const files::JsonValue used = record["frames"]["used"];
  if (used.count() != frames.rows().size()) {
    throw used.error(fmt::format("the {} frames of frames.csv", frames.rows().size()));
  }
  if (record["timing_ms"].is_null()) return;
  double total = 0;
  for (const double milliseconds : frames.column("total_ms")) total += milliseconds;
  const files::JsonValue stated = record["timing_ms"]["total"];
  if (std::abs(stated.number() - total) > kSameTime * total) {
    throw stated.error(fmt::format("the sum of total_ms in frames.csv, {}", total));
  }
}

}  // namespace

void require_frames(const FrameTable& frames, const geometry::Trajectory& estimate,
                    const files::JsonValue& record, const RunFolder& folder) {
  const FramesCheck check(frames, folder);
  check.require_columns(!record["timing_ms"].is_null());
  check.require_rows(estimate.size());
  check.require_values("stamp_s", kSameStamp_s, "the stamp of the pose in trajectory.tum",
                       [&](std::size_t i) { return estimate.stamp(i).seconds(); });
  const auto first = static_cast<double>(record["frames"]["first"].count());
  check.require_values("frame", 0, "the number of the frame",
                       [&](std::size_t i) { return first + static_cast<double>(i); });
  for (const char* name : kCounts) check.require_within(name, kMostCounted, true);
  for (const std::string& name : frames.columns()) {
    if (name.ends_with("_ms")) check.require_within(name, kMostMilliseconds, false);
  }
  require_record_of(frames, record);
}

}  // namespace traverse::pipeline
