#include <string_view>
#include <utility>

#include "kitti/kitti_bin.hpp"
#include "kitti/kitti_lidar.hpp"
#include "navigation_log/tables_beside.hpp"
#include "recording/folder_opening.hpp"
#include "recording/stamp_files.hpp"
#include "recording/unused_files.hpp"

namespace traverse::dataset {

namespace {

namespace fs = std::filesystem;

/// Poses of the camera: poses.txt in the folder (SemanticKITTI), or dataset/poses/00.txt for
/// dataset/sequences/00 (the benchmark).
std::optional<ReferenceFile> find_poses(const fs::path& folder) {
  const fs::path sequence = fs::canonical(folder);
  const fs::path benchmark =
      sequence.parent_path().parent_path() / "poses" / (sequence.filename().string() + ".txt");
  for (const fs::path& file : {folder / "poses.txt", benchmark}) {
    if (!fs::is_regular_file(file)) continue;
    return ReferenceFile{file, TrajectoryFormat::kKitti, ReferenceFrame::kCamera,
                         "found where the KITTI layout has it",
                         "poses of the KITTI odometry benchmark are the camera's"};
  }
  return std::nullopt;
}

}  // namespace

std::unique_ptr<Source> open_kitti_odometry(const fs::path& folder, const OpenOptions& options,
                                            std::string_view format) {
  const Statements statements(folder / "traverse.yaml", options, folder);
  FolderRecording recording;
  RecordingInfo& info = recording.info;
  info = begin_info(folder, format, statements, "lidar");
  set_motion_compensation(info, statements, true,
                          "scans of the KITTI odometry benchmark are motion-compensated");

  recording.lidar = kVelodyne;

  const std::vector<fs::path> files = files_with_extension(folder / "velodyne", ".bin");
  PoseStamps pose_stamps;
  if (const fs::path times = folder / "times.txt"; fs::exists(times)) {
    const StampFile lines = read_stamps(times);
    const auto stamps = settled_stamps(lines, "scans", info.facts);
    pose_stamps = stamps_of(stamps);
    recording.scans = stamp_by_line(files, stamps, name_with_form(lines), "scan", info.facts);
  } else {
    recording.scans = stamp_by_period(files, statements, info.facts);
    pose_stamps = stamps_of(recording.scans);
  }
  info.expected_scans = recording.scans.size();
  recording.read = mount_kitti_lidar(info, files, recording.scans, statements, options);

  set_camera(info, statements, folder / "calib.txt");
  recording.reference = choose_reference(info, statements, find_poses(folder), pose_stamps);
  add_tables(recording, folder, statements);
  note_unused_files(info, options, recording.reference, pose_stamps.size());
  return make_folder_source(std::move(recording));
}

}  // namespace traverse::dataset
