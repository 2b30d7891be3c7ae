#include "traverse/dataset/trajectory_files.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/LU>
#include <fmt/format.h>

#include "traverse/bags/message_container.hpp"
#include "traverse/dataset/trajectory_streams.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/numbers.hpp"
#include "traverse/files/text_file.hpp"

#include "trajectories/g2o_poses.hpp"
#include "trajectories/named_columns.hpp"
#include "trajectories/pose_sequence.hpp"
#include "trajectories/pose_topics.hpp"

namespace traverse::dataset {

using files::LineReader;
using geometry::Pose3;
using geometry::Stamp;
using geometry::Trajectory;
using Words = std::vector<std::string_view>;

namespace {

constexpr std::size_t kTumColumns = 8;
constexpr std::size_t kKittiColumns = 12;
constexpr std::size_t kNumberedKittiColumns = kKittiColumns + 1;
constexpr std::size_t kEurocColumns = 8;  // the least: files of the data set go on with velocities
constexpr std::string_view kEurocHeader =
    "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z "
    "[]";

/// Files with three decimals in the rotation pass, a matrix with scale or a wrong column order not.
constexpr double kRotationTolerance = 1e-2;

bool is_rotation(const Eigen::Matrix3d& R) {
  const Eigen::Array33d deviation = (R * R.transpose() - Eigen::Matrix3d::Identity()).array().abs();
  return (deviation < kRotationTolerance).all() && R.determinant() > 0;
}

/// Through the wider type both ways, so that what a round trip changes is the rounding of the four
/// numbers in the file and nothing else.
using WideQuaternion = Eigen::Quaternion<long double>;

Eigen::Quaterniond quaternion_of(const Eigen::Matrix3d& R) {
  WideQuaternion q(R.cast<long double>().eval());
  q.normalize();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  return q.cast<double>();
}

Eigen::Vector3d position(const LineReader& reader, const Words& words, std::size_t first) {
  return {finite_number(reader, words[first]), finite_number(reader, words[first + 1]),
          finite_number(reader, words[first + 2])};
}

/// `time` and what it means if it is a Unix time in `units` other than the one expected.
std::string time_found(std::string_view time, std::string_view instead) {
  std::string found = files::in_quotes(time);
  const auto number = files::parse_double(time);
  const auto unit = number ? geometry::unix_time_unit(*number) : std::nullopt;
  if (unit) {
    found += fmt::format(", {} if it is a Unix time: {}", geometry::name_of(*unit), instead);
  }
  return found;
}

Eigen::Vector4d quaternion_columns(const LineReader& reader, const Words& words,
                                   std::size_t first) {
  const Eigen::Vector3d three = position(reader, words, first);
  return {three.x(), three.y(), three.z(), finite_number(reader, words[first + 3])};
}

std::vector<std::string> read_tum(LineReader& reader, const PoseTaker& take) {
  PosesInOrder poses(take, false);
  while (reader.next()) {
    const Words words = files::split_words(reader.line());
    if (words.size() != kTumColumns) {
      throw reader.error("the 8 columns t x y z qx qy qz qw of a TUM file",
                         fmt::format("{}", words.size()));
    }
    const auto stamp = geometry::parse_stamp_seconds(words[0]);
    if (!stamp) {
      throw reader.error("a time in seconds, below 9.2e9",
                         time_found(words[0],
                                    "write seconds, or a EuRoC file, whose times are "
                                    "nanoseconds (commas between, w before x y z)"));
    }
    poses.add(reader, *stamp, position(reader, words, 1), quaternion_columns(reader, words, 4));
  }
  return poses.notes();
}

std::vector<std::string> read_euroc(LineReader& reader, const PoseTaker& take) {
  PosesInOrder poses(take, true);
  while (reader.next()) {
    const Words cells = files::split_cells(reader.line(), ',');
    if (cells.size() < kEurocColumns) {
      throw reader.error("at least the 8 columns t,x,y,z,qw,qx,qy,qz of a EuRoC file",
                         fmt::format("{}", cells.size()));
    }
    const auto stamp = geometry::parse_stamp_nanoseconds(cells[0]);
    if (!stamp) {
      throw reader.error("a time in whole nanoseconds",
                         time_found(cells[0],
                                    "write nanoseconds, or a TUM file, whose times are "
                                    "seconds (blanks between, w after x y z)"));
    }
    poses.add(reader, *stamp, position(reader, cells, 1), quaternion_columns(reader, cells, 4));
  }
  return poses.notes();
}

/// The frame number before a pose of KITTI-360.
std::size_t frame_number(const LineReader& reader, std::string_view word,
                         const std::vector<std::size_t>& before) {
  const auto number = geometry::parse_stamp_nanoseconds(word);  // 12, but also 1.2e+01
  const std::int64_t least = before.empty() ? 0 : static_cast<std::int64_t>(before.back()) + 1;
  if (!number || number->nanoseconds < least) {
    throw reader.error(fmt::format("a frame number from {} on", least), files::in_quotes(word));
  }
  return static_cast<std::size_t>(number->nanoseconds);
}

/// The Unix time before a pose, as MulRan has it, which no frame number is as large as.
std::optional<Stamp> stamp_before_matrix(std::string_view word) {
  const auto number = files::parse_double(word);
  const auto unit = number ? geometry::unix_time_unit(*number) : std::nullopt;
  return unit ? geometry::parse_unix_time(word, *unit) : std::nullopt;
}

std::vector<std::size_t> read_kitti(LineReader& reader, const PoseTaker& take) {
  std::optional<Stamp> last;
  std::vector<std::size_t> frame_numbers;
  std::size_t columns = 0;
  bool any = false;
  while (reader.next()) {
    const bool has_commas = reader.line().find(',') != std::string::npos;
    const Words words =
        has_commas ? files::split_cells(reader.line(), ',') : files::split_words(reader.line());
    if (columns == 0)
      columns = words.size() == kNumberedKittiColumns ? words.size() : kKittiColumns;
    if (words.size() != columns) {
      throw reader.error(columns == kKittiColumns
                             ? "the 12 numbers of a 3x4 matrix of a KITTI file"
                             : "a frame number and the 12 numbers of a 3x4 matrix of a KITTI file",
                         fmt::format("{}", words.size()));
    }
    const std::size_t begin = columns - kKittiColumns;
    std::optional<Stamp> stamp;
    if (begin > 0) stamp = stamp_before_matrix(words[0]);
    if (begin > 0 && !stamp) {
      frame_numbers.push_back(frame_number(reader, words[0], frame_numbers));
    }
    if (stamp.has_value() != last.has_value() && any) {
      throw reader.error("a time before every pose, or before none", files::in_quotes(words[0]));
    }
    if (stamp && last && *stamp < *last) {
      throw reader.error("times that do not go back", files::in_quotes(words[0]));
    }
    last = stamp;
    any = true;
    Pose3 pose;
    for (Eigen::Index row = 0; row < 3; ++row) {
      const std::size_t first = begin + static_cast<std::size_t>(4 * row);
      pose.rotation.row(row) = position(reader, words, first).transpose();
      pose.translation[row] = finite_number(reader, words[first + 3]);
    }
    if (!is_rotation(pose.rotation)) {
      throw reader.error("a rotation matrix in columns 1-3, 5-7, 9-11", "another matrix");
    }
    take(stamp, pose);
  }
  return frame_numbers;
}

void read_as(const std::filesystem::path& file, const TrajectoryChoice& choice,
             const PoseTaker& take, TrajectoryReading& reading) {
  if (reading.format == TrajectoryFormat::kBag) {
    read_pose_topic(file, choice.topic, take, reading);
    return;
  }
  LineReader reader(file);
  switch (reading.format) {
    case TrajectoryFormat::kTum:
      reading.notes = read_tum(reader, take);
      break;
    case TrajectoryFormat::kKitti:
      reading.frame_numbers = read_kitti(reader, take);
      break;
    case TrajectoryFormat::kEuroc:
      reading.notes = read_euroc(reader, take);
      break;
    case TrajectoryFormat::kCsv:
      read_named_columns(reader, choice.columns, take, reading);
      break;
    case TrajectoryFormat::kG2o:
      read_g2o(reader, take, reading);
      break;
    case TrajectoryFormat::kBag:
    case TrajectoryFormat::kAuto:
      break;
  }
}

/// The format of a file by its first line with data, and what in it says so.
TrajectoryReading detect(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file)) {
    return {TrajectoryFormat::kBag, "a folder", {}, {}};
  }
  if (bags::is_ros1_bag(file) || bags::is_mcap(file) || bags::is_sqlite(file)) {
    return {TrajectoryFormat::kBag, "its first bytes are a bag's", {}, {}};
  }
  LineReader reader(file);
  bool has_two_times = false;  // in a comment, where other headers are left alone
  do {
    if (!reader.next(LineReader::Comments::kGive)) {
      throw files::InputError(file, files::Place::whole_file(), "at least one pose", "none");
    }
    has_two_times = has_two_times || names_nanoseconds_beside_seconds(reader.line());
  } while (reader.line().starts_with('#'));
  const auto as = [](TrajectoryFormat format, std::string reason) {
    return TrajectoryReading{format, std::move(reason), {}, {}};
  };
  if (is_g2o(reader.line())) return as(TrajectoryFormat::kG2o, "lines that begin with a word");
  if (has_two_times || names_columns(reader.line())) {
    return as(TrajectoryFormat::kCsv, "a header that names the columns");
  }
  if (reader.line().find(',') != std::string::npos) {
    return files::split_cells(reader.line(), ',').size() == kNumberedKittiColumns
               ? as(TrajectoryFormat::kKitti, "12 columns after a time, commas between")
               : as(TrajectoryFormat::kEuroc, "commas between the columns");
  }
  const std::size_t columns = files::split_words(reader.line()).size();
  if (columns == kTumColumns) return as(TrajectoryFormat::kTum, "8 columns between blanks");
  if (columns == kKittiColumns) return as(TrajectoryFormat::kKitti, "12 columns between blanks");
  if (columns == kNumberedKittiColumns) {
    return as(TrajectoryFormat::kKitti, "12 columns after a frame number");
  }
  throw reader.error(
      "a pose with 8 columns (TUM), 12 columns or 13 with a frame number or a time (KITTI), commas "
      "(EuRoC), a header with x, y, z, qx, qy, qz, qw among its names (CSV), VERTEX_SE3:QUAT (g2o) "
      "or a bag");
}

void require_poses(const Trajectory& trajectory) {
  for (const Pose3& pose : trajectory.poses()) {
    if (!pose.translation.allFinite() || !is_rotation(pose.rotation)) {
      throw std::invalid_argument("a pose to write is not finite or not a rotation");
    }
  }
}

void require_ordered_stamps(const Trajectory& trajectory, std::string_view format) {
  if (!trajectory.is_stamped() && !trajectory.empty()) {
    throw std::invalid_argument(fmt::format("a {} file needs stamps", format));
  }
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    if (trajectory.stamp(i) < trajectory.stamp(i - 1)) {
      throw std::invalid_argument(fmt::format("the stamps to write go back at pose {}", i));
    }
  }
}

}  // namespace

std::string_view name_of(TrajectoryFormat format) {
  for (const auto& [name, named] : kTrajectoryFormatNames) {
    if (named == format) return name;
  }
  return "unknown";
}

std::string describe(const TrajectoryReading& reading) {
  constexpr std::array<std::pair<TrajectoryFormat, std::string_view>, 6> kTitles{
      {{TrajectoryFormat::kTum, "TUM"},
       {TrajectoryFormat::kKitti, "KITTI"},
       {TrajectoryFormat::kEuroc, "EuRoC"},
       {TrajectoryFormat::kCsv, "CSV"},
       {TrajectoryFormat::kG2o, "g2o"},
       {TrajectoryFormat::kBag, "bag"}}};
  for (const auto& [format, title] : kTitles) {
    if (format == reading.format) return fmt::format("{}, {}", title, reading.reason);
  }
  return reading.reason;
}

TrajectoryFormat detect_trajectory_format(const std::filesystem::path& file) {
  return detect(file).format;
}

TrajectoryReading read_poses(const std::filesystem::path& file, TrajectoryFormat format,
                             const PoseTaker& take) {
  return read_poses(file, TrajectoryChoice{format}, take);
}

TrajectoryReading read_poses(const std::filesystem::path& file, const TrajectoryChoice& choice,
                             const PoseTaker& take) {
  const TrajectoryFormat format = choice.format;
  TrajectoryReading reading{format, "as asked for", {}, {}};
  if (format == TrajectoryFormat::kAuto && !choice.columns.empty()) {
    reading = {TrajectoryFormat::kCsv, "its columns are named", {}, {}};
  } else if (format == TrajectoryFormat::kAuto && !choice.topic.empty()) {
    reading = {TrajectoryFormat::kBag, "a topic is named", {}, {}};
  } else if (format == TrajectoryFormat::kAuto) {
    reading = detect(file);
  }
  bool any = false;
  const auto take_any = [&](const std::optional<Stamp>& stamp, const Pose3& pose) {
    any = true;
    take(stamp, pose);
  };
  read_as(file, choice, take_any, reading);
  if (format == TrajectoryFormat::kKitti && !reading.frame_numbers.empty()) {
    reading.reason += ", with frame numbers";
  }
  if (any) return reading;
  throw files::InputError(file, files::Place::whole_file(), "at least one pose", "none");
}

Trajectory read_trajectory(const std::filesystem::path& file, TrajectoryFormat format,
                           TrajectoryReading* reading) {
  return read_trajectory(file, TrajectoryChoice{format}, reading);
}

Trajectory read_trajectory(const std::filesystem::path& file, const TrajectoryChoice& choice,
                           TrajectoryReading* reading) {
  std::vector<Stamp> stamps;
  std::vector<Pose3> poses;
  TrajectoryReading how =
      read_poses(file, choice, [&](const std::optional<Stamp>& stamp, const Pose3& pose) {
        if (stamp) stamps.push_back(*stamp);
        poses.push_back(pose);
      });
  if (reading != nullptr) *reading = std::move(how);
  return stamps.empty() ? Trajectory::unstamped(std::move(poses))
                        : Trajectory::stamped(std::move(stamps), std::move(poses));
}

void write_tum(std::ostream& stream, const Trajectory& T_map_body) {
  require_ordered_stamps(T_map_body, "TUM");
  require_poses(T_map_body);
  for (std::size_t i = 0; i < T_map_body.size(); ++i) {
    const Eigen::Vector3d& t = T_map_body.pose(i).translation;
    const Eigen::Quaterniond q = quaternion_of(T_map_body.pose(i).rotation);
    stream << to_text(T_map_body.stamp(i));
    for (const double value : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) {
      stream << ' ' << files::to_text(value);
    }
    stream << '\n';
  }
}

void write_tum(const std::filesystem::path& file, const Trajectory& T_map_body) {
  files::AtomicFile output(file);
  write_tum(output.stream(), T_map_body);
  output.commit();
}

void write_euroc(const std::filesystem::path& file, const Trajectory& T_map_body) {
  require_ordered_stamps(T_map_body, "EuRoC");
  require_poses(T_map_body);
  files::AtomicFile output(file);
  output.stream() << kEurocHeader << '\n';
  for (std::size_t i = 0; i < T_map_body.size(); ++i) {
    const Eigen::Vector3d& t = T_map_body.pose(i).translation;
    const Eigen::Quaterniond q = quaternion_of(T_map_body.pose(i).rotation);
    output.stream() << T_map_body.stamp(i).nanoseconds;
    for (const double value : {t.x(), t.y(), t.z(), q.w(), q.x(), q.y(), q.z()}) {
      output.stream() << ',' << files::to_text(value);
    }
    output.stream() << '\n';
  }
  output.commit();
}

void write_kitti(std::ostream& stream, const Trajectory& T_map_body) {
  require_poses(T_map_body);
  for (const Pose3& pose : T_map_body.poses()) {
    for (Eigen::Index row = 0; row < 3; ++row) {
      for (Eigen::Index column = 0; column < 3; ++column) {
        stream << files::to_text(pose.rotation(row, column)) << ' ';
      }
      stream << files::to_text(pose.translation[row]) << (row < 2 ? ' ' : '\n');
    }
  }
}

void write_kitti(const std::filesystem::path& file, const Trajectory& T_map_body) {
  files::AtomicFile output(file);
  write_kitti(output.stream(), T_map_body);
  output.commit();
}

}  // namespace traverse::dataset
