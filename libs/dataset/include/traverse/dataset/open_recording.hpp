#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "traverse/config/document.hpp"
#include "traverse/dataset/source.hpp"

namespace traverse::dataset {

/// What the user says about a recording beyond what stands beside it.
///
/// A recording states facts about itself in traverse.yaml beside its data (X.traverse.yaml beside
/// X.rawlog). Keys, each optional:
///
///     name: Drive 1                 for titles
///     motion_compensated: false     true: the points of a scan already lie where they would at
///                                   its stamp
///     sensor: hdl64e_kitti          a profile in SHARE/sensors, or a file relative to this one
///     lidar:                        any key of a profile, stronger than the profile, and which
///       rings: 64                   fields of a point hold what:
///       ring_field: laser_id
///       time_field: offset_time
///       time_unit: us               s | ms | us | ns; else from the interval of scans
///       time_zero: start            stamp | epoch: what times count from; start | middle | end:
///                                   where in a sweep its stamp is, and differences of times count
///       metadata: os1.json          of the Ouster whose packets a capture or bag holds
///     reference:
///       file: poses_velo.txt        relative to the recording's folder
///       format: kitti               auto | tum | kitti | euroc
///       frame: lidar                body | lidar | camera
///       topic: /ground_truth        of a bag, instead of a file
///       north_deg: 90               true north in the file's map, from x towards y; if known
///     wheels: {topic: /joint_states, radius_m: 0.1}   of a bag; lidar, imu, gnss: a topic or none
///     accept: gnss_late             contradictions (docs/contradictions.md) to go on with
///     point_unit_m: 0.001           metres that a 1 in a point's coordinates means
///     point_time_unit_s: 1e-6       seconds that a 1 in a point's time means; else from intervals
///     bin:                          of .bin files; else what fits
///       columns: x y z intensity ring   or how many
///       type: float64               auto | float32 | float64 | nclt
///     imu: {unit: g, angular_rate: deg}  m_s2 | g | mg | increment; rad | deg | increment
///     gnss:                         what the numbers of a fix mean
///       order: longitude_latitude   latitude_longitude | longitude_latitude
///       unit: ddmm                  deg | rad | ddmm
///       heading: from_east          from_north | from_east | counterclockwise
///       heading_unit: deg           deg | rad
///       delay_s: 0.2                a fix is of so long before its stamp
///     calibration: calib.txt        in KITTI's form: Tr, or Tr_velo_to_cam with R0_rect
///     body_frame: lidar             what reports call the body
///     lidars: front,rear            that are used as one; lidars_late_s: 0.003   else as found
///     first_stamp: 1317042145.964   seconds, and period_s: 0.1, for folders without stamps
///     vehicle:                      mounting in the body frame: x ahead, y left, z up
///       imu: {position_m: [0, 0, 0], roll_pitch_yaw_deg: [0, 0, 0]}
///       gnss: {position_m: [0, 0, 0], heading_offset_deg: 0}
///       wheels: {position_m: [0, 0, 0], left_m_per_pulse: 0, right_m_per_pulse: 0}
///     log: {angular_rate: rad, pulses: interval, time_unit_s: 1}   of a text log
///     csv: ...                      columns of a folder of CSV files: share/recordings has
///     examples
struct OpenOptions {
  /// Statements in the form of traverse.yaml, stronger than the file: from a YAML file and from
  /// --recording key=value on the command line.
  std::optional<std::filesystem::path> statements_file;
  std::vector<std::string> statements;  ///< "motion_compensated=true", "lidar.sweep_s=0.1"
  /// SHARE: the folder with sensors/*.yaml.
  std::filesystem::path share_folder;
  /// False: whoever opens it has the reference already; the file that is stated need not be there.
  bool wants_reference = true;
  /// False: whoever opens it wants to know what there is; a recording of messages that none can be
  /// used of is opened too.
  bool wants_measurements = true;
};

/// What `options` state, each key for itself, so that it holds from any working directory: a file
/// is named by its absolute path unless it stands beside the recording.
/// \throws files::InputError as open_recording() for a file of statements that cannot be read
std::vector<std::string> lasting_statements(const std::filesystem::path& recording,
                                            const OpenOptions& options);

/// Opens a recording, finding out its format from what is there (recording_formats.hpp).
/// \throws files::InputError if it is of none that is known or cannot be read.
std::unique_ptr<Source> open_recording(const std::filesystem::path& path,
                                       const OpenOptions& options);

}  // namespace traverse::dataset
