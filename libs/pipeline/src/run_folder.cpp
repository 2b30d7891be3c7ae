#include "traverse/pipeline/run_folder.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>

#include "traverse/evaluation/checkpoints.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"

namespace traverse::pipeline {

namespace {

/// Those of libs/report, which makes none of another name.
constexpr std::array<std::string_view, 22> kPictures{
    "association",      "error-distribution",
    "error-over-time",  "error-violins",
    "health-over-time", "kitti-drift",
    "kitti-segments",   "loops-above",
    "map-height",       "map-intensity",
    "map-perspective",  "map-slice",
    "map-slice-above",  "navigation-accelerometer-bias",
    "navigation-fixes", "navigation-gyro-bias",
    "navigation-nis",   "scan-features",
    "timing-stages",    "trajectory-above",
    "trajectory-error", "trajectory-side"};

/// "worst-segment-3": a name with a number.
constexpr std::string_view kNumbered = "worst-segment-";

bool remove_end(std::string_view& text, std::string_view end) {
  if (!text.ends_with(end)) return false;
  text.remove_suffix(end.size());
  return true;
}

}  // namespace

std::vector<std::filesystem::path> RunFolder::files() const {
  return {record(),
          trajectory(),
          utm_trajectory(),
          odometry(),
          odometry_evaluation(),
          loops(),
          keyframes(),
          reference(),
          frames(),
          map_points(),
          simple_map(),
          origin(),
          geodetic_path(),
          geodetic_line(),
          sample_scan(),
          worst_frames(),
          evaluation(),
          path / evaluation::kCheckpointsFile,
          jacobians(),
          factor_bench(),
          report(),
          report_json(),
          las()};
}

bool RunFolder::is_picture(std::string_view name) {
  const bool has_ending =
      remove_end(name, ".png") || remove_end(name, ".svg") || remove_end(name, ".pdf");
  if (!has_ending) return false;
  if (!remove_end(name, "_dark")) remove_end(name, "_print");
  if (name.starts_with(kNumbered)) {
    name.remove_prefix(kNumbered.size());
    return !name.empty() && name.find_first_not_of("0123456789") == std::string_view::npos;
  }
  return std::find(kPictures.begin(), kPictures.end(), name) != kPictures.end();
}

void RunFolder::prepare() const {
  files::make_writable_folder(path);
  std::error_code failure;
  const bool empty = std::filesystem::is_empty(path, failure);
  if (failure) throw files::OutputError(path, failure.message());
  if (!empty) throw files::OutputError(path, "something is in it");
}

}  // namespace traverse::pipeline
