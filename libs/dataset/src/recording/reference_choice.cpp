#include "recording/reference_choice.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

namespace traverse::dataset {

using files::InputError;
using files::Place;
using geometry::Pose3;
using geometry::Trajectory;

namespace {

Trajectory with_stamps(const Trajectory& poses, const PoseStamps& stamps,
                       const std::vector<std::size_t>& numbers, const std::filesystem::path& file) {
  if (stamps.empty()) {
    throw InputError(file, Place::whole_file(), "poses with stamps (TUM or EuRoC)",
                     "poses without");
  }
  if (!numbers.empty() && numbers.back() >= stamps.size()) {
    throw InputError(file, Place::whole_file(),
                     fmt::format("frame numbers below {}, the number of stamps", stamps.size()),
                     fmt::format("{}", numbers.back()));
  }
  if (numbers.empty() && poses.size() != stamps.size()) {
    throw InputError(file, Place::whole_file(),
                     fmt::format("{} poses, as many as there are stamps", stamps.size()),
                     fmt::format("{}", poses.size()));
  }
  Trajectory result;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto& stamp = stamps[numbers.empty() ? i : numbers[i]];
    if (stamp) result.push_back(*stamp, poses.pose(i));
  }
  return result;
}

std::optional<Pose3> T_body_sensor(ReferenceFrame frame, const ReferenceFrames& frames) {
  switch (frame) {
    case ReferenceFrame::kBody:
      return Pose3::identity();
    case ReferenceFrame::kLidar:
      return frames.T_body_lidar;
    case ReferenceFrame::kCamera:
      return frames.T_body_camera;
  }
  return std::nullopt;
}

}  // namespace

std::optional<ReferenceFile> stated_reference(const Statements& statements) {
  if (!statements.want_reference() || !statements.states("reference.file")) return std::nullopt;
  ReferenceFile file;
  file.file = statements.find_file("reference.file", statements->reference_file);
  file.format = statements->reference_format;
  file.frame = statements->reference_frame;
  if (statements.states("reference.north_deg")) file.north_deg = statements->reference_north_deg;
  file.reason = *statements.origin("reference.file");
  file.frame_reason = statements.reason("reference.frame", "default, not stated");
  return file;
}

Reference load_reference(const ReferenceFile& file, const ReferenceFrames& frames,
                         const PoseStamps& stamps, std::vector<Fact>& facts) {
  TrajectoryReading reading;
  Trajectory poses = read_trajectory(file.file, file.format, &reading);
  std::string description;
  if (!poses.is_stamped()) {
    poses = with_stamps(poses, stamps, reading.frame_numbers, file.file);
    description = reading.frame_numbers.empty()
                      ? "pose i has the stamp of scan i; "
                      : "a pose has the stamp of the scan of its number; ";
  }
  const auto X = T_body_sensor(file.frame, frames);
  if (!X) {
    throw InputError(file.file, Place::whole_file(),
                     "a calibration that tells where the camera is, for poses of the camera",
                     "none");
  }
  std::optional<Eigen::Vector3d> north_map;
  if (file.north_deg) {
    const double north = *file.north_deg * std::numbers::pi / 180;
    north_map = X->rotation * Eigen::Vector3d(std::cos(north), std::sin(north), 0);
  }
  if (file.frame == ReferenceFrame::kBody) {
    description += "poses of the body as they stand";
  } else {
    poses = poses.transformed_left(*X).transformed_right(X->inverse());
    description += fmt::format("poses of the {0}, T_body = X T_{0} X^-1 with X = T_body_{0}",
                               name_of(file.frame));
  }
  facts.push_back({"reference", file.file.string(), file.reason});
  facts.push_back({"reference read as", std::string(name_of(reading.format)), reading.reason});
  for (const std::string& note : reading.notes) {
    facts.push_back({"reference, to be checked", note, file.file.filename().string()});
  }
  facts.push_back({"reference frame", description, file.frame_reason});
  return {std::move(poses), file.file, std::move(description), north_map};
}

}  // namespace traverse::dataset
