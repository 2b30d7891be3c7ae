#include "traverse/pipeline/run_keyframes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"
#include "traverse/mapping/map_origin.hpp"
#include "traverse/pipeline/run_contents.hpp"
#include "traverse/pipeline/run_digests.hpp"

#include "next_step.hpp"

namespace traverse::pipeline {

namespace {

namespace fs = std::filesystem;
using files::InputError;
using files::Place;

constexpr std::int64_t kTick_ns = 1000;  // MRPT's stamps count ten times as fine
constexpr double kWithinVehicle_m = 20;  // of a sensor from the body

struct KeyframePlace {
  geometry::Stamp stamp;
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();
};

/// The pose of the frame that the keyframe was made of, or null.
const geometry::Pose3* pose_of(const KeyframePlace& keyframe, const geometry::Trajectory& path) {
  const geometry::Stamp earliest{keyframe.stamp.nanoseconds - kTick_ns};
  const auto& stamps = path.stamps();
  const auto found = std::lower_bound(stamps.begin(), stamps.end(), earliest);
  if (found == stamps.end()) return nullptr;
  if (std::abs(geometry::seconds_between(keyframe.stamp, *found)) * 1e9 > kTick_ns) return nullptr;
  return &path.pose(static_cast<std::size_t>(found - stamps.begin()));
}

/// Somebody's own map may lie beside the run's.
bool is_of_run(const RunFolder& folder, const fs::path& file) {
  const auto names = folder.files();
  return std::any_of(names.begin(), names.end(),
                     [&](const fs::path& own) { return own.filename() == file.filename(); });
}

/// What `read` gives of a file; the next step is told where a run wrote it.
template <typename Read>
auto read_of_run(const fs::path& file, const Read& read) {
  const RunFolder folder{file.parent_path()};
  if (!fs::exists(folder.record())) return read(file);
  if (is_of_run(folder, file)) require_as_written(folder, {file});
  return with_next_step([&] { return read(file); });
}

/// That the keyframes are those of the run in the folder of the file, if there is one.
void require_of_run(const fs::path& file, const std::vector<KeyframePlace>& keyframes) {
  const RunFolder folder{file.parent_path()};
  if (!fs::exists(folder.record())) return;
  const RunContents run = read_run(folder, RunPart::kFrames);
  with_next_step([&] {
    for (std::size_t k = 0; k < keyframes.size(); ++k) {
      const geometry::Pose3* pose = pose_of(keyframes[k], run.estimate);
      if (pose == nullptr) {
        throw InputError(file, Place::record(k), "a keyframe of a frame in trajectory.tum",
                         "the stamp " + to_text(keyframes[k].stamp) + ", which no frame has");
      }
      const double away_m = (pose->translation - keyframes[k].p_map).norm();
      if (away_m <= kWithinVehicle_m) continue;
      throw InputError(file, Place::record(k),
                       fmt::format("a keyframe within {} m of its frame's pose in trajectory.tum",
                                   kWithinVehicle_m),
                       fmt::format("one {:.1f} m away", away_m));
    }
  });
}

fs::path simple_map_of(const fs::path& run) {
  if (!fs::is_directory(run)) return run;
  const RunFolder folder{run};
  // Keyframes of slam are denser.
  return fs::exists(folder.keyframes()) ? folder.keyframes() : folder.simple_map();
}

}  // namespace

std::vector<mapping::MapKeyframe> read_map_keyframes(const fs::path& run) {
  const fs::path file = simple_map_of(run);
  auto keyframes = read_of_run(file, mapping::read_simple_map);
  std::vector<KeyframePlace> places;
  for (const auto& keyframe : keyframes) {
    places.push_back({keyframe.stamp, keyframe.T_map_body.translation});
  }
  require_of_run(file, places);
  return keyframes;
}

std::optional<geodesy::Geodetic> read_origin(const RunFolder& folder) {
  if (!fs::exists(folder.origin())) return std::nullopt;
  return read_of_run(folder.origin(), mapping::read_map_origin);
}

std::vector<slam::MapKeyframe> read_localization_map(const fs::path& file) {
  auto keyframes = read_of_run(file, slam::read_keyframes);
  std::vector<KeyframePlace> places;
  for (const auto& keyframe : keyframes) {
    places.push_back({keyframe.stamp, keyframe.T_map_lidar.translation});
  }
  require_of_run(file, places);
  return keyframes;
}

}  // namespace traverse::pipeline
