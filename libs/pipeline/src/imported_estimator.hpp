#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "traverse/pipeline/estimator.hpp"
#include "traverse/pipeline/imported_poses.hpp"

namespace traverse::pipeline {

/// Gives each scan of the first lidar the pose that another program found for it: at its stamp
/// between its neighbours in time, or by its number. What that program knew of its frames is not
/// known here, and so is no part of the record.
class ImportedEstimator final : public Estimator {
 public:
  /// \throws files::InputError as read_imported_poses() and read_foreign_timing();
  /// std::runtime_error if the rig has no lidar
  ImportedEstimator(const ImportOptions& options, const dataset::RecordingInfo& recording);

  const std::vector<std::string>& columns() const override;
  bool depends_on(sensors::SensorKind /*kind*/) const override { return false; }
  std::vector<PoseFrame> process(const sensors::Measurement& measurement) override;
  std::vector<PoseFrame> finish() override;
  UsedScan used_scan(const sensors::LidarScan& scan, const PoseFrame& frame,
                     bool with_classes) const override;
  std::string points_are() const override;
  std::vector<Decision> decisions() const override;
  std::vector<SensorUse> sensor_use() const override;
  std::vector<HealthReason> troubles() const override;
  std::optional<ForeignTiming> foreign() const override { return timing_; }
  std::unique_ptr<Estimator> clone() const override {
    return std::unique_ptr<Estimator>(new ImportedEstimator(*this));
  }

 private:
  ImportedEstimator(const ImportedEstimator&) = default;

  /// A frame whose velocity may need the pose after it.
  struct Waiting {
    PoseFrame frame;
    double begin_s = 0;  ///< of its sweep, after its stamp
    double end_s = 0;
  };

  std::vector<PoseFrame> take(const sensors::LidarScan& scan);
  /// The pose of scan `number`; its index among the poses, or of the one after it.
  std::optional<PoseFrame> frame_at(geometry::Stamp stamp, std::size_t number);
  geometry::Twist velocity_over(geometry::Stamp stamp, double begin_s, double end_s) const;
  PoseFrame released(Waiting waiting) const;
  /// \throws std::runtime_error about poses of which none is of a scan
  [[noreturn]] void require_a_pose() const;
  std::size_t scans() const { return next_scan_ - first_scan_; }

  ImportOptions options_;
  sensors::MountedSensor sensor_;
  std::string deskew_note_;
  std::shared_ptr<const ImportedPoses> poses_;
  ForeignTiming timing_;
  std::size_t first_scan_;
  std::size_t next_scan_;
  geometry::Stamp first_stamp_;  ///< of the scans
  geometry::Stamp last_stamp_;
  geometry::Trajectory placed_;  ///< poses that go by number, with the stamps of their scans
  std::optional<Waiting> waiting_;
  std::size_t taken_ = 0;         ///< scans at a pose
  std::size_t interpolated_ = 0;  ///< scans between poses
  std::size_t before_ = 0;        ///< scans without a pose: before the first one
  std::size_t after_ = 0;         ///< after the last one
  std::size_t in_gaps_ = 0;       ///< where poses are too far apart, or their numbers have a gap
  double widest_s_ = 0;           ///< of the gaps that were interpolated over
};

}  // namespace traverse::pipeline
