#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "traverse/geometry/trajectory.hpp"

/// Trajectories as files, in the forms that the field exchanges.
///
/// TUM    `t x y z qx qy qz qw`, seconds and metres, blanks between
/// KITTI  the twelve numbers of the upper 3x4 of T_map_body, row after row; no stamps. A frame
/// number
///        may stand before them, as in KITTI-360
/// EuRoC  `t,x,y,z,qw,qx,qy,qz`, whole nanoseconds (also as 1.7e+18), commas between; further
///        columns are allowed
///
/// CSV    a header that names the columns, or names that are given; commas, semicolons or blanks
/// g2o    the lines `VERTEX_SE3:QUAT id x y z qx qy qz qw`, in the order of their ids
/// bag    a topic of poses in a ROS 1 bag, a ROS 2 bag or MCAP: Odometry, PoseStamped,
///        PoseWithCovarianceStamped, TransformStamped, Path (the last one)
///
/// '#' begins a comment line. A file that is written and read back has the same stamps to the
/// nanosecond and the same positions to the bit, KITTI files also the same rotation. Where a
/// quaternion stands in the file, a matrix R comes back as the rotation nearest to it:
/// max |R' - R| <= 4e-16 + max |R R^T - I|, and one that was read from a file before comes back
/// within 2.3e-16 (one unit in the last place of 1).
namespace traverse::dataset {

enum class TrajectoryFormat { kAuto, kTum, kKitti, kEuroc, kCsv, kG2o, kBag };

/// The names that the command line uses.
inline constexpr std::array<std::pair<std::string_view, TrajectoryFormat>, 7>
    kTrajectoryFormatNames{{{"auto", TrajectoryFormat::kAuto},
                            {"tum", TrajectoryFormat::kTum},
                            {"kitti", TrajectoryFormat::kKitti},
                            {"euroc", TrajectoryFormat::kEuroc},
                            {"csv", TrajectoryFormat::kCsv},
                            {"g2o", TrajectoryFormat::kG2o},
                            {"bag", TrajectoryFormat::kBag}}};

/// "auto", "tum", "kitti", "euroc", "csv", "g2o", "bag".
std::string_view name_of(TrajectoryFormat format);

/// How a trajectory is to be read.
struct TrajectoryChoice {
  TrajectoryFormat format = TrajectoryFormat::kAuto;
  /// Of CSV files: what the columns are, one after the other ("t,x,y,z,qx,qy,qz,qw", `_` for
  /// others), or which of the header's names they are ("t=when,x=east"). Empty: the header tells.
  /// Times are seconds; t_ms, t_us and t_ns are others.
  std::string columns = {};
  std::string topic = {};  ///< of bags; empty: the only one with poses
};

/// As what a file of a trajectory was read.
struct TrajectoryReading {
  TrajectoryFormat format = TrajectoryFormat::kAuto;
  std::string reason;  ///< why this format: "8 columns between blanks", "as asked for"
  /// What a reader may want to know: quaternions that had to be normalised, their columns perhaps
  /// in another order. Whole sentences without a full stop.
  std::vector<std::string> notes;
  /// Of KITTI files that have them, and the ids of g2o; they grow.
  std::vector<std::size_t> frame_numbers;
};
/// "TUM, 8 columns between blanks".
std::string describe(const TrajectoryReading& reading);

/// The format of `file`, from its first line with data: commas make it EuRoC, eight columns TUM,
/// twelve, or thirteen with a frame number, KITTI, names of columns CSV, VERTEX_ and EDGE_ g2o;
/// bags from their first bytes, and folders are bags. \throws files::InputError if it is none of
/// these.
TrajectoryFormat detect_trajectory_format(const std::filesystem::path& file);

/// Reads T_map_body; kAuto finds out the format. Quaternions are normalised, KITTI's numbers are
/// kept as they stand.
/// \param reading if not null, gets how the file was read
/// \throws files::InputError naming the line, what was expected there and what was found: columns
/// missing or surplus, a word that is no finite number, a quaternion whose length is off by more
/// than a tenth, nine numbers that are no rotation (to 1e-2), a stamp before its predecessor (equal
/// ones are allowed), no pose.
geometry::Trajectory read_trajectory(const std::filesystem::path& file, TrajectoryFormat format,
                                     TrajectoryReading* reading = nullptr);

geometry::Trajectory read_trajectory(const std::filesystem::path& file,
                                     const TrajectoryChoice& choice,
                                     TrajectoryReading* reading = nullptr);

/// Takes the poses of a file one after the other, with their stamps where the format has them.
using PoseTaker =
    std::function<void(const std::optional<geometry::Stamp>&, const geometry::Pose3& T_map_body)>;

/// The same without keeping the poses. \throws as read_trajectory(), after those before were taken
TrajectoryReading read_poses(const std::filesystem::path& file, TrajectoryFormat format,
                             const PoseTaker& take);
TrajectoryReading read_poses(const std::filesystem::path& file, const TrajectoryChoice& choice,
                             const PoseTaker& take);

/// Write T_map_body; the file appears whole or not at all. A trajectory without poses gives a file
/// without poses.
/// \throws std::invalid_argument if read_trajectory() would refuse the result: no stamps where the
/// format needs them, stamps that go back, a number that is not finite, a matrix that is no
/// rotation; files::OutputError.
void write_tum(const std::filesystem::path& file, const geometry::Trajectory& T_map_body);
void write_kitti(const std::filesystem::path& file, const geometry::Trajectory& T_map_body);
void write_euroc(const std::filesystem::path& file, const geometry::Trajectory& T_map_body);

}  // namespace traverse::dataset
