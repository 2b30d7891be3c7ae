#include "traverse/dataset/trajectory_files.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/LU>
#include <fmt/format.h>

#include "traverse/dataset/trajectory_streams.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/numbers.hpp"
#include "traverse/files/text_file.hpp"

namespace traverse::dataset {

using files::LineReader;
using geometry::Pose3;
using geometry::Stamp;
using geometry::Trajectory;
using Words = std::vector<std::string_view>;

namespace {

constexpr std::size_t kTumColumns = 8;
constexpr std::size_t kKittiColumns = 12;
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

Eigen::Matrix3d rotation_of(const Eigen::Quaterniond& q) {
  return q.cast<long double>().normalized().toRotationMatrix().cast<double>();
}

Eigen::Quaterniond quaternion_of(const Eigen::Matrix3d& R) {
  WideQuaternion q(R.cast<long double>().eval());
  q.normalize();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  return q.cast<double>();
}

double finite_number(const LineReader& reader, std::string_view word) {
  const auto number = files::parse_double(word);
  if (!number || !std::isfinite(*number)) {
    throw reader.error("a finite number", files::in_quotes(word));
  }
  return *number;
}

Eigen::Vector3d position(const LineReader& reader, const Words& words, std::size_t first) {
  return {finite_number(reader, words[first]), finite_number(reader, words[first + 1]),
          finite_number(reader, words[first + 2])};
}

Pose3 pose_from_quaternion(const LineReader& reader, const Eigen::Quaterniond& q,
                           const Eigen::Vector3d& t) {
  if (!std::isnormal(q.squaredNorm())) {
    throw reader.error("a quaternion of length 1", fmt::format("one of length {}", q.norm()));
  }
  return {rotation_of(q), t};
}

/// Hands the poses of a file on, and looks at the order of their stamps.
struct PosesInOrder {
  const PoseTaker& take;
  std::optional<Stamp> last = std::nullopt;
};

void add_in_order(PosesInOrder& poses, const LineReader& reader, Stamp stamp, const Pose3& pose) {
  if (poses.last && stamp < *poses.last) {
    throw reader.error(fmt::format("a stamp not before the last one, {}", to_text(*poses.last)),
                       to_text(stamp));
  }
  poses.last = stamp;
  poses.take(stamp, pose);
}

void read_tum(LineReader& reader, const PoseTaker& take) {
  PosesInOrder poses{take};
  while (reader.next()) {
    const Words words = files::split_words(reader.line());
    if (words.size() != kTumColumns) {
      throw reader.error("the 8 columns t x y z qx qy qz qw of a TUM file",
                         fmt::format("{}", words.size()));
    }
    const auto stamp = geometry::parse_stamp_seconds(words[0]);
    if (!stamp) {
      throw reader.error("a time in seconds, below 9.2e9", files::in_quotes(words[0]));
    }
    const Eigen::Vector3d t = position(reader, words, 1);
    const Eigen::Vector3d q_xyz = position(reader, words, 4);
    const Eigen::Quaterniond q(finite_number(reader, words[7]), q_xyz.x(), q_xyz.y(), q_xyz.z());
    add_in_order(poses, reader, *stamp, pose_from_quaternion(reader, q, t));
  }
}

void read_euroc(LineReader& reader, const PoseTaker& take) {
  PosesInOrder poses{take};
  while (reader.next()) {
    const Words cells = files::split_cells(reader.line(), ',');
    if (cells.size() < kEurocColumns) {
      throw reader.error("at least the 8 columns t,x,y,z,qw,qx,qy,qz of a EuRoC file",
                         fmt::format("{}", cells.size()));
    }
    const auto nanoseconds = files::parse_integer(cells[0]);
    if (!nanoseconds) {
      throw reader.error("a time in whole nanoseconds", files::in_quotes(cells[0]));
    }
    const Eigen::Vector3d t = position(reader, cells, 1);
    const Eigen::Vector3d q_xyz = position(reader, cells, 5);
    const Eigen::Quaterniond q(finite_number(reader, cells[4]), q_xyz.x(), q_xyz.y(), q_xyz.z());
    add_in_order(poses, reader, Stamp{*nanoseconds}, pose_from_quaternion(reader, q, t));
  }
}

void read_kitti(LineReader& reader, const PoseTaker& take) {
  while (reader.next()) {
    const Words words = files::split_words(reader.line());
    if (words.size() != kKittiColumns) {
      throw reader.error("the 12 numbers of a 3x4 matrix of a KITTI file",
                         fmt::format("{}", words.size()));
    }
    Pose3 pose;
    for (Eigen::Index row = 0; row < 3; ++row) {
      const auto first = static_cast<std::size_t>(4 * row);
      pose.rotation.row(row) = position(reader, words, first).transpose();
      pose.translation[row] = finite_number(reader, words[first + 3]);
    }
    if (!is_rotation(pose.rotation)) {
      throw reader.error("a rotation matrix in columns 1-3, 5-7, 9-11", "another matrix");
    }
    take(std::nullopt, pose);
  }
}

void read_as(const std::filesystem::path& file, TrajectoryFormat format, const PoseTaker& take) {
  LineReader reader(file);
  switch (format) {
    case TrajectoryFormat::kTum:
      return read_tum(reader, take);
    case TrajectoryFormat::kKitti:
      return read_kitti(reader, take);
    case TrajectoryFormat::kEuroc:
      return read_euroc(reader, take);
    case TrajectoryFormat::kAuto:
      break;
  }
  read_as(file, detect_trajectory_format(file), take);
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

TrajectoryFormat detect_trajectory_format(const std::filesystem::path& file) {
  LineReader reader(file);
  if (!reader.next()) {
    throw files::InputError(file, files::Place::whole_file(), "at least one pose", "none");
  }
  if (reader.line().find(',') != std::string::npos) return TrajectoryFormat::kEuroc;
  const std::size_t columns = files::split_words(reader.line()).size();
  if (columns == kTumColumns) return TrajectoryFormat::kTum;
  if (columns == kKittiColumns) return TrajectoryFormat::kKitti;
  throw reader.error("a pose with 8 columns (TUM), 12 columns (KITTI) or commas (EuRoC)");
}

void read_poses(const std::filesystem::path& file, TrajectoryFormat format, const PoseTaker& take) {
  bool any = false;
  read_as(file, format, [&](const std::optional<Stamp>& stamp, const Pose3& pose) {
    any = true;
    take(stamp, pose);
  });
  if (any) return;
  throw files::InputError(file, files::Place::whole_file(), "at least one pose", "none");
}

Trajectory read_trajectory(const std::filesystem::path& file, TrajectoryFormat format) {
  std::vector<Stamp> stamps;
  std::vector<Pose3> poses;
  read_poses(file, format, [&](const std::optional<Stamp>& stamp, const Pose3& pose) {
    if (stamp) stamps.push_back(*stamp);
    poses.push_back(pose);
  });
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
