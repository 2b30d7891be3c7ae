#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/dataset/recording_writer.hpp"
#include "traverse/files/atomic_file.hpp"

#include "kitti/kitti_bin.hpp"
#include "point_clouds/cloud_scan.hpp"
#include "point_clouds/scan_completion.hpp"
#include "point_clouds/sensor_tables.hpp"
#include "recording/recording_files.hpp"
#include "recording/sidecar.hpp"

namespace traverse::dataset {

using sensors::LidarScan;

namespace {

namespace fs = std::filesystem;

class ScanFolderWriter : public RecordingWriter {
 public:
  ScanFolderWriter(const fs::path& folder, const RecordingInfo& info,
                   const std::optional<Reference>& reference, const sensors::MountedSensor& lidar,
                   ScanFolderFormat format)
      : folder_(folder),
        files_(RecordingFiles::within(folder_.temporary_path())),
        scans_(format == ScanFolderFormat::kKitti ? folder_.temporary_path() / "velodyne"
                                                  : folder_.temporary_path()),
        label_(lidar.label),
        profile_(lidar.lidar.value_or(sensors::LidarProfile())),
        format_(format),
        rig_(info.rig),
        T_lidar_body_(lidar.T_body_sensor.inverse()),
        tables_(info.rig, left_out_) {
    fs::create_directories(scans_);
    const geometry::Pose3& T_lidar_body = T_lidar_body_;
    sidecar_.name = info.name;
    sidecar_.motion_compensated = info.motion_compensated;
    sidecar_.body_frame = "lidar";
    if (reference) {
      sidecar_.reference = reference->T_map_body.transformed_left(T_lidar_body)
                               .transformed_right(lidar.T_body_sensor);
      if (reference->north_map) {
        sidecar_.north_map = T_lidar_body.rotation * *reference->north_map;
      }
    }
    if (info.T_body_camera) {
      sidecar_.T_camera_lidar = info.T_body_camera->inverse() * lidar.T_body_sensor;
    }
  }

  void add(const sensors::Measurement& measurement) override {
    const auto* scan = std::get_if<std::shared_ptr<const LidarScan>>(&measurement);
    if (scan != nullptr && (*scan)->sensor == label_) {
      add_scan(**scan);
    } else if (!tables_.add(measurement)) {
      ++left_out_["measurements of " + sensor_of(measurement)];
    }
  }

  void add_file(const std::string& name, const std::string& text) override {
    files_.write(name, text);
  }

  void commit() override {
    files_.write("times.txt", times_);
    const bool stores = format_ != ScanFolderFormat::kKitti;
    for (const auto& [name, text] : tables_.files()) files_.write(name, text);
    if (!tables_.files().empty()) {
      sensors::Rig rig_of_lidar = rig_;  // the body of the folder is the lidar
      for (sensors::MountedSensor& sensor : rig_of_lidar.sensors) {
        sensor.T_body_sensor = T_lidar_body_ * sensor.T_body_sensor;
      }
      sidecar_.vehicle = vehicle_statements_of(rig_of_lidar);
    }
    sidecar_.profile = stored_in_data(profile_, stores && has_rings_, stores && has_times_);
    commit_with_sidecar(sidecar_, files_);
    folder_.commit();
  }

 private:
  void add_scan(const LidarScan& scan) {
    const std::string name = fmt::format("{:06d}", count_++);
    times_ += to_text(scan.stamp) + "\n";
    if (format_ == ScanFolderFormat::kKitti) {
      if (!scan.ring.empty()) ++left_out_["ring numbers, by scan"];
      if (!scan.time.empty()) ++left_out_["point times, by scan"];
      write_kitti_bin(scans_ / (name + ".bin"), scan);
      return;
    }
    DerivedPointData derived = derive_point_data(scan, profile_);
    has_rings_ = has_rings_ || !derived.ring.empty();
    has_times_ = has_times_ || !derived.time.empty();
    const PointCloud cloud = cloud_from_scan(scan, std::move(derived));
    if (format_ == ScanFolderFormat::kPcd) {
      write_pcd(scans_ / (name + ".pcd"), cloud);
    } else {
      write_ply(scans_ / (name + ".ply"), cloud);
    }
  }

  files::AtomicFolder folder_;
  RecordingFiles files_;  ///< beside the scans
  fs::path scans_;
  std::string label_;
  sensors::LidarProfile profile_;
  ScanFolderFormat format_;
  const sensors::Rig& rig_;  ///< that of a rawlog grows while it is read
  geometry::Pose3 T_lidar_body_;
  SensorTables tables_;
  Sidecar sidecar_;
  std::string times_;
  std::size_t count_ = 0;
  bool has_rings_ = false;
  bool has_times_ = false;
};

}  // namespace

std::unique_ptr<RecordingWriter> write_scan_folder(const fs::path& folder,
                                                   const RecordingInfo& info,
                                                   const std::optional<Reference>& reference,
                                                   const std::string& lidar,
                                                   ScanFolderFormat format) {
  const sensors::MountedSensor* mounted = info.rig.find(lidar);
  if (mounted == nullptr || mounted->kind != sensors::SensorKind::kLidar) {
    throw std::invalid_argument("the recording has no lidar '" + lidar + "'");
  }
  return std::make_unique<ScanFolderWriter>(folder, info, reference, *mounted, format);
}

}  // namespace traverse::dataset
