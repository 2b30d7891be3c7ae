#include "kitti/kitti_lidar.hpp"

#include <utility>

#include "kitti/kitti_bin.hpp"
#include "point_clouds/bin_points.hpp"
#include "point_clouds/point_statements.hpp"
#include "recording/folder_opening.hpp"

namespace traverse::dataset {

ScanReader mount_kitti_lidar(RecordingInfo& info, const std::vector<std::filesystem::path>& files,
                             const std::vector<ScanFile>& scans, const Statements& statements,
                             const OpenOptions& options) {
  const BinLayout layout = bin_layout(files, statements, info.facts);
  if (!layout.is_kitti()) {
    return mount_cloud_lidar(
        info, kVelodyne, scans,
        [layout](const std::filesystem::path& file) { return read_bin_points(file, layout); },
        statements, options);
  }
  note_idle_point_statements(statements, "", "the files hold coordinates and intensity alone",
                             info.facts);
  ProfileChoice profile = installed_profile(options.share_folder, "hdl64e_kitti");
  profile.reason += ", default for KITTI";
  mount_lidar(info, kVelodyne, choose_profile(statements, options.share_folder, std::move(profile)),
              statements);
  return [unit_m = statements->point_unit_m](const ScanFile& scan) {
    return in_metres(read_kitti_bin(scan.file), unit_m);
  };
}

}  // namespace traverse::dataset
