#include "traverse/pipeline/imported_poses.hpp"

#include <array>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "traverse/config/document.hpp"
#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/pipeline/estimator.hpp"

namespace traverse::pipeline {

namespace {

using files::InputError;
using files::Place;
using geometry::Pose3;

constexpr std::array<std::string_view, 3> kImportFrames{"body", "lidar", "camera"};

/// The pose of what moves along the file's poses, in the frame that is named.
Pose3 extrinsic_of(const std::vector<double>& numbers) {
  constexpr double kTolerance = 1e-2;  // as for files of trajectories
  const auto fail = [](const std::string& found) {
    return InputError("--extrinsic", Place::whole_file(),
                      "x y z qx qy qz qw of a unit quaternion, or the 12 numbers of a 3x4 matrix "
                      "with a rotation in columns 1-3, 5-7, 9-11",
                      found);
  };
  if (numbers.empty()) return {};
  for (const double number : numbers) {
    if (!std::isfinite(number)) throw fail("a number that is not finite");
  }
  if (numbers.size() == 7) {
    const Eigen::Quaterniond q(numbers[6], numbers[3], numbers[4], numbers[5]);
    if (std::abs(q.norm() - 1) > kTolerance) {
      throw fail(fmt::format("a quaternion of length {:.4g}", q.norm()));
    }
    return Pose3::from_quaternion(q.normalized(), {numbers[0], numbers[1], numbers[2]});
  }
  if (numbers.size() != 12) throw fail(fmt::format("{} numbers", numbers.size()));
  Pose3 pose;
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 3; ++column) {
      pose.rotation(row, column) = numbers[static_cast<std::size_t>(4 * row + column)];
    }
    pose.translation[row] = numbers[static_cast<std::size_t>(4 * row + 3)];
  }
  const double off = (pose.rotation * pose.rotation.transpose() - Eigen::Matrix3d::Identity())
                         .cwiseAbs()
                         .maxCoeff();
  if (off > kTolerance || pose.rotation.determinant() < 0) throw fail("another matrix");
  return pose.orthonormalised();
}

Pose3 frame_in_body(const std::string& frame, const dataset::RecordingInfo& recording) {
  if (frame == "body") return {};
  if (frame == "camera") {
    if (recording.T_body_camera) return *recording.T_body_camera;
    throw InputError(recording.path, Place::whole_file(),
                     "a calibration of camera 0, since --frame camera is asked for",
                     "none; state the poses' frame by --frame lidar and --extrinsic");
  }
  const sensors::MountedSensor* lidar = recording.rig.first(sensors::SensorKind::kLidar);
  if (lidar != nullptr) return lidar->T_body_sensor;
  throw InputError(recording.path, Place::whole_file(),
                   "a 3-D lidar, since --frame lidar is asked for",
                   "none; --frame body takes the poses as they are");
}

/// How upright a vehicle stands: 1 is upright in the map, -1 on its roof.
double uprightness(const Pose3& T_map_body) { return T_map_body.rotation(2, 2); }

/// From the axes that the poses are told in to those of the map: as for references those of what
/// moves along them are turned into the body's, which is right where a trajectory begins with no
/// rotation, or stay, where the vehicle stands more upright in them, as in axes that point up.
Pose3 map_of_world(const Pose3& first_T_world_moving, const Pose3& T_body_moving) {
  constexpr double kMoreUpright = 0.1;
  const Pose3 as_they_are = first_T_world_moving * T_body_moving.inverse();
  const Pose3 turned = T_body_moving * as_they_are;
  return uprightness(as_they_are) > uprightness(turned) + kMoreUpright ? Pose3() : T_body_moving;
}

}  // namespace

void bind(config::Binder& b, ImportOptions& o) {
  b.group("poses", "poses that another program made", [&](config::Binder& g) {
    std::array<std::string_view, dataset::kTrajectoryFormatNames.size()> formats;
    for (std::size_t i = 0; i < formats.size(); ++i) {
      formats[i] = dataset::kTrajectoryFormatNames[i].first;
    }
    g.text("file", o.file, "trajectory file or bag");
    g.word("format", o.format, formats, "of the file; auto looks at the content");
    g.text("columns", o.columns, "of a CSV file, where its header does not name them");
    g.text("topic", o.topic, "of a bag; empty: the only one with poses");
    g.word("frame", o.frame, kImportFrames, "what moves along the poses");
    g.numbers("extrinsic", o.extrinsic,
              "pose of what moves along them in that frame: x y z [m] qx qy qz qw, or 3x4");
    g.number("time_offset_s", o.time_offset_s, config::Range::between(-9.2e9, 9.2e9),
             "added to the stamps of the poses, seconds");
    g.text("time_offset_reason", o.time_offset_reason, "where that number comes from");
    g.number("max_gap_s", o.max_gap_s, config::Range::between(0, 3600),
             "poses further apart are not interpolated between, seconds");
    g.flag("deskew", o.deskew, "undo the motion within a sweep, by the poses' own motion");
    g.integer("first_scan", o.first_scan, config::Range::non_negative(),
              "number of the first scan that is read, for poses that go by number");
    g.text("timing", o.timing, "YAML file of what the other program's run cost");
  });
}

ImportedPoses read_imported_poses(const ImportOptions& options,
                                  const dataset::RecordingInfo& recording) {
  ImportedPoses poses;
  dataset::TrajectoryChoice choice;
  for (const auto& [name, format] : dataset::kTrajectoryFormatNames) {
    if (name == options.format) choice.format = format;
  }
  choice.columns = options.columns;
  choice.topic = options.topic;
  dataset::TrajectoryReading reading;
  const geometry::Trajectory given = dataset::read_trajectory(options.file, choice, &reading);
  poses.read_as = describe(reading);
  poses.notes = reading.notes;

  const Pose3 T_body_frame = frame_in_body(options.frame, recording);
  const Pose3 T_body_moving = T_body_frame * extrinsic_of(options.extrinsic);
  const Pose3 T_map_world = map_of_world(given.pose(0), T_body_moving);
  poses.T_map_body = given.transformed_right(T_body_moving.inverse()).transformed_left(T_map_world);
  if (!given.is_stamped()) {
    poses.scans = reading.frame_numbers;
    for (std::size_t i = poses.scans.size(); i < given.size(); ++i) poses.scans.push_back(i);
    return poses;
  }
  std::vector<geometry::Stamp> stamps;
  for (const geometry::Stamp stamp : given.stamps()) {
    stamps.push_back(geometry::shifted(stamp, options.time_offset_s));
  }
  poses.T_map_body = geometry::Trajectory::stamped(std::move(stamps), poses.T_map_body.poses());
  return poses;
}

ForeignTiming read_foreign_timing(const std::string& file, std::size_t poses) {
  constexpr double kLongest = 1e12;
  constexpr double kNotGiven = 0;
  std::int64_t threads = 0;
  double wall_s = kNotGiven;
  double peak_memory_mb = kNotGiven;
  ForeignTiming timing;
  config::read(config::Document::load(file), [&](config::Binder& b) {
    b.integer("threads", threads, config::Range::between(1, 1'000'000), "of the program");
    b.number("wall_s", wall_s, {0, kLongest}, "wall time of its run, seconds");
    b.number("peak_memory_mb", peak_memory_mb, {0, kLongest}, "the most memory it took, MB");
    b.numbers("frame_ms", timing.frame_ms, "time of each pose, milliseconds");
  });
  if (threads > 0) timing.threads = static_cast<int>(threads);
  if (wall_s > 0) timing.wall_s = wall_s;
  if (peak_memory_mb > 0) timing.peak_memory_mb = peak_memory_mb;
  if (!timing.frame_ms.empty() && timing.frame_ms.size() != poses) {
    throw InputError(file, Place::key("frame_ms"),
                     fmt::format("{} numbers, one for each pose", poses),
                     fmt::format("{}", timing.frame_ms.size()));
  }
  for (const double ms : timing.frame_ms) {
    if (ms >= 0 && ms <= kLongest) continue;
    throw InputError(file, Place::key("frame_ms"), "milliseconds from 0 on", fmt::format("{}", ms));
  }
  return timing;
}

Preset imported_preset(const std::string& name, const std::vector<std::string>& assignments) {
  Preset preset;
  preset.name = name;
  preset.file = "traverse import";
  for (config::Document* document : {&preset.as_shipped, &preset.resolved}) {
    document->set("estimator=imported_poses", "traverse import");
    document->set("description=poses that another program made", "traverse import");
  }
  for (const std::string& assignment : assignments) {
    preset.resolved.set(assignment, "traverse import");
  }
  return preset;
}

std::optional<ForeignTiming> Estimator::foreign() const { return std::nullopt; }

}  // namespace traverse::pipeline
