#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"

#include "kitti/kitti_bin.hpp"
#include "kitti/kitti_lidar.hpp"
#include "kitti/oxts.hpp"
#include "navigation_log/tables_beside.hpp"
#include "recording/folder_opening.hpp"
#include "recording/stamp_files.hpp"
#include "recording/unused_files.hpp"

namespace traverse::dataset {

using files::InputError;
using geometry::Pose3;

namespace {

namespace fs = std::filesystem;

constexpr const char* kImu = "oxts_imu";
constexpr const char* kGnss = "oxts_gnss";
constexpr const char* kTimes = "timestamps.txt";

struct OxtsStream {
  std::vector<OxtsPacket> packets;  ///< that can be used, their stamps growing
  std::vector<SideRecord> records;  ///< all of them
};

OxtsStream read_oxts(const fs::path& folder, const std::vector<RecordStamp>& stamps,
                     const fs::path& recording, std::vector<Fact>& facts) {
  OxtsStream stream;
  const std::vector<fs::path> files = files_with_extension(folder / "data", ".txt");
  if (files.empty() || !fs::exists(folder / kTimes)) return stream;
  const OxtsReader reader(folder / "dataformat.txt");
  const auto stamped = stamp_by_line(files, stamps, "oxts/timestamps.txt", "oxts", facts);
  geometry::Stamp last_stamp;
  for (const ScanFile& file : stamped) {
    const std::string place = file.file.lexically_relative(recording).generic_string();
    if (!file.stamp) {
      const std::string fault = std::string_view(file.fault) == StampSequence::kNone
                                    ? "no stamp for the oxts packet"
                                    : std::string(file.fault);
      stream.records.push_back({std::nullopt, last_stamp, fault, place});
      continue;
    }
    last_stamp = *file.stamp;
    try {
      const OxtsPacket packet = reader.read(file.file, last_stamp);
      stream.records.push_back({imu_sample(packet, kImu), last_stamp, "", place});
      stream.records.push_back({gnss_fix(packet, kGnss), last_stamp, "", place});
      stream.packets.push_back(packet);
    } catch (const InputError& error) {
      stream.records.push_back({std::nullopt, last_stamp,
                                "oxts packet cannot be used: expected " + error.expected(),
                                fmt::format("{} (found {})", place, error.found())});
    }
  }
  return stream;
}

StampFile stamps_if_there(const fs::path& file) {
  return fs::exists(file) ? read_stamps(file) : StampFile{};
}

/// Calibration files of a drive stand in the folder of its date.
std::optional<fs::path> find_calibration(const fs::path& drive, const char* name) {
  const fs::path folder = fs::canonical(drive);
  for (const fs::path& file : {folder / name, folder.parent_path() / name}) {
    if (fs::exists(file)) return file;
  }
  return std::nullopt;
}

/// T_lidar_imu, or the identity when its file is not there.
Pose3 imu_calibration(const fs::path& drive, std::vector<Fact>& facts) {
  const auto file = find_calibration(drive, "calib_imu_to_velo.txt");
  if (!file) {
    facts.push_back({"IMU calibration", "none: the IMU is taken to be at the lidar",
                     "no calib_imu_to_velo.txt in the drive's folder or the one above"});
    return Pose3::identity();
  }
  facts.push_back({"IMU calibration", file->string(), "found where the KITTI layout has it"});
  return read_raw_calibration(*file);
}

void set_raw_camera(RecordingInfo& info, const Statements& statements, const fs::path& drive) {
  if (statements.states("calibration")) {
    set_camera(info, statements, {});
    return;
  }
  const auto velo_to_cam = find_calibration(drive, "calib_velo_to_cam.txt");
  const auto cam_to_cam = find_calibration(drive, "calib_cam_to_cam.txt");
  if (!velo_to_cam || !cam_to_cam) return;
  info.T_body_camera = read_raw_camera_calibration(*velo_to_cam, *cam_to_cam).inverse();
  info.facts.push_back({"calibration",
                        "camera 0 from R_rect_00 of " + cam_to_cam->string() + " and " +
                            velo_to_cam->filename().string(),
                        "found where the KITTI layout has it"});
}

/// The path that the inertial navigation system tells, as the lidar's.
std::optional<Reference> oxts_reference(const OxtsStream& stream, const Pose3& T_lidar_imu,
                                        const fs::path& folder, std::vector<Fact>& facts) {
  if (stream.packets.size() < 2) return std::nullopt;
  Reference reference;
  reference.T_map_body = mercator_trajectory(stream.packets)
                             .transformed_left(T_lidar_imu)
                             .transformed_right(T_lidar_imu.inverse());
  reference.north_map = T_lidar_imu.rotation * north_imu(stream.packets.front());
  reference.file = folder;
  reference.description =
      "GNSS/INS on a Mercator map (the devkit's convertOxtsToPose), "
      "T_lidar = X T_imu X^-1 with X = T_lidar_imu";
  facts.push_back({"reference", folder.string(), "found where the KITTI layout has it"});
  facts.push_back({"reference frame", reference.description, "KITTI raw data development kit"});
  return reference;
}

}  // namespace

std::unique_ptr<Source> open_kitti_raw(const fs::path& folder, const OpenOptions& options,
                                       std::string_view format) {
  const Statements statements(folder / "traverse.yaml", options, folder);
  FolderRecording recording;
  RecordingInfo& info = recording.info;
  info = begin_info(folder, format, statements, "lidar");
  set_motion_compensation(info, statements, false, "scans of KITTI raw are as measured");

  recording.lidar = kVelodyne;

  const fs::path points = folder / "velodyne_points";
  const std::vector<fs::path> files = files_with_extension(points / "data", ".bin");
  const std::array<StampFile, 2> times{stamps_if_there(points / kTimes),
                                       stamps_if_there(folder / "oxts" / kTimes)};
  std::array<SensorStamps, 2> stamps{sensor_stamps(times[0], "scans"),
                                     sensor_stamps(times[1], "oxts packets")};
  settle_steps(stamps, info.facts);
  if (fs::exists(points / kTimes)) {
    recording.scans = stamp_by_line(files, stamps[0].sequence.records,
                                    "velodyne_points/timestamps.txt", "scan", info.facts);
  } else {
    recording.scans = stamp_by_period(files, statements, info.facts);
  }
  info.expected_scans = recording.scans.size();
  recording.read = mount_kitti_lidar(info, files, recording.scans, statements, options);
  set_raw_camera(info, statements, folder);

  OxtsStream oxts = read_oxts(folder / "oxts", stamps[1].sequence.records, folder, info.facts);
  Pose3 T_lidar_imu;
  if (!oxts.packets.empty()) {
    T_lidar_imu = imu_calibration(folder, info.facts);
    info.rig.sensors.push_back({kImu, sensors::SensorKind::kImu, T_lidar_imu, std::nullopt});
    info.rig.sensors.push_back({kGnss, sensors::SensorKind::kGnss, T_lidar_imu, std::nullopt});
  }
  recording.reference =
      choose_reference(info, statements, std::nullopt, stamps_of(recording.scans));
  if (!recording.reference) {
    recording.reference = oxts_reference(oxts, T_lidar_imu, folder / "oxts", info.facts);
    if (recording.reference) info.reference_receiver = kGnss;
  }
  const bool has_oxts = !oxts.packets.empty();
  recording.others = std::move(oxts.records);
  // Drives of other cars in this layout have tables instead.
  if (!has_oxts) add_tables(recording, folder, statements);
  note_unused_files(info, options, recording.reference, info.expected_scans);
  return make_folder_source(std::move(recording));
}

}  // namespace traverse::dataset
