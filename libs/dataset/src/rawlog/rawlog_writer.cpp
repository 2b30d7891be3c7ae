#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <mrpt/serialization/CArchive.h>

#include "traverse/dataset/recording_writer.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/mrpt_io/gz_stream.hpp"
#include "traverse/mrpt_io/mrpt_values.hpp"
#include "traverse/sensors/gga_quality.hpp"

#include "point_clouds/scan_completion.hpp"
#include "recording/recording_files.hpp"
#include "recording/sidecar.hpp"

namespace traverse::dataset {

using geometry::Pose3;
using sensors::GnssFix;
using sensors::ImuSample;
using sensors::LidarScan;
using sensors::PlanarScan;
using sensors::WheelOdometry;

namespace {

namespace fs = std::filesystem;

std::uint8_t scaled_intensity(float intensity, double full_scale) {
  const double share = intensity / full_scale;
  return std::isnan(share)
             ? std::uint8_t{0}
             : static_cast<std::uint8_t>(std::lround(std::clamp(share, 0.0, 1.0) * 255));
}

mrpt::obs::CObservationVelodyneScan to_observation(const LidarScan& scan,
                                                   const sensors::LidarProfile& profile,
                                                   const DerivedPointData& derived) {
  mrpt::obs::CObservationVelodyneScan observation;
  observation.minRange = profile.min_range_m;
  observation.maxRange = profile.max_range_m;
  auto& cloud = observation.point_cloud;
  cloud.x = scan.x;
  cloud.y = scan.y;
  cloud.z = scan.z;
  cloud.intensity.resize(scan.size());  // MRPT's viewers expect one a point
  if (!scan.intensity.empty()) {
    std::transform(
        scan.intensity.begin(), scan.intensity.end(), cloud.intensity.begin(),
        [&](float value) { return scaled_intensity(value, profile.intensity_full_scale); });
  }
  cloud.laser_id.reserve(derived.ring.size());
  for (const std::uint16_t ring : derived.ring) {
    cloud.laser_id.push_back(static_cast<std::int16_t>(ring));
  }
  cloud.timestamp.reserve(derived.time.size());
  // Ticks from the stamp's own tick, so that times within the sweep are rounded once.
  const mrpt::Clock::time_point stamp = mrpt_io::to_mrpt(scan.stamp);
  for (const float time : derived.time) {
    constexpr double kFarthest = 1e10;  // ticks that a stamp can be moved by in any case
    const double ticks = std::isnan(time) ? 0 : std::clamp(time * 1e7, -kFarthest, kFarthest);
    cloud.timestamp.push_back(stamp + mrpt::Clock::duration(std::llround(ticks)));
  }
  return observation;
}

/// MRPT's scans are symmetric about their sensor's x axis; a scan that is not has its middle turned
/// there.
mrpt::obs::CObservation2DRangeScan to_observation(const PlanarScan& scan, Pose3& T_body_sensor) {
  mrpt::obs::CObservation2DRangeScan observation;
  const std::size_t count = scan.ranges_m.size();
  const double span = scan.azimuth_step * static_cast<double>(count > 0 ? count - 1 : 0);
  const double middle = scan.first_azimuth + span / 2;
  T_body_sensor =
      T_body_sensor * geometry::exp_se3((geometry::Twist() << 0, 0, middle, 0, 0, 0).finished());
  observation.aperture = static_cast<float>(std::abs(span));
  observation.rightToLeft = span >= 0;
  observation.maxRange = static_cast<float>(scan.max_range_m);
  observation.resizeScanAndAssign(count, 0, false);
  for (std::size_t i = 0; i < count; ++i) {
    if (std::isnan(scan.ranges_m[i])) continue;
    observation.setScanRange(i, scan.ranges_m[i]);
    observation.setScanRangeValidity(i, true);
  }
  return observation;
}

mrpt::obs::CObservationIMU to_observation(const ImuSample& sample) {
  mrpt::obs::CObservationIMU observation;
  observation.set(mrpt::obs::IMU_X_ACC, sample.specific_force.x());
  observation.set(mrpt::obs::IMU_Y_ACC, sample.specific_force.y());
  observation.set(mrpt::obs::IMU_Z_ACC, sample.specific_force.z());
  observation.set(mrpt::obs::IMU_WX, sample.angular_rate.x());
  observation.set(mrpt::obs::IMU_WY, sample.angular_rate.y());
  observation.set(mrpt::obs::IMU_WZ, sample.angular_rate.z());
  return observation;
}

/// Numbers and lengths of Novatel's messages. Source: MRPT 2.5.8, gnss_messages_type_list.h and the
/// fields in gnss_messages_novatel.h, without header and checksum.
constexpr std::uint16_t kBestPosition = 42;
constexpr std::uint16_t kBestPositionBytes = 72;
constexpr std::uint16_t kInertialAttitude = 508;
constexpr std::uint8_t kInertialAttitudeBytes = 88;
constexpr std::uint8_t kLongHeaderBytes = 28;
constexpr std::uint32_t kWgs84 = 61;

/// A fix with its standard deviations.
mrpt::obs::gnss::Message_NV_OEM6_BESTPOS best_position(const GnssFix& fix) {
  using mrpt::obs::gnss::nv_oem6_header_t;
  mrpt::obs::gnss::Message_NV_OEM6_BESTPOS message;
  auto& fields = message.fields;
  fields.header.synch[0] = nv_oem6_header_t::SYNCH0;
  fields.header.synch[1] = nv_oem6_header_t::SYNCH1;
  fields.header.synch[2] = nv_oem6_header_t::SYNCH2;
  fields.header.hdr_len = kLongHeaderBytes;
  fields.header.msg_id = kBestPosition;
  fields.header.msg_len = kBestPositionBytes;
  fields.solution_stat = mrpt::obs::gnss::nv_oem6_solution_status::SOL_COMPUTED;
  fields.position_type = mrpt::obs::gnss::nv_oem6_position_type::SINGLE;
  fields.lat = fix.latitude_deg;
  fields.lon = fix.longitude_deg;
  fields.hgt = fix.altitude_m;
  fields.datum_id = kWgs84;
  const Eigen::Vector3d sigmas_enu = fix.covariance_enu->diagonal().cwiseSqrt();
  fields.lon_sigma = static_cast<float>(sigmas_enu.x());
  fields.lat_sigma = static_cast<float>(sigmas_enu.y());
  fields.hgt_sigma = static_cast<float>(sigmas_enu.z());
  return message;
}

/// A fix with its heading.
mrpt::obs::gnss::Message_NV_OEM6_INSPVAS inertial_attitude(const GnssFix& fix) {
  using mrpt::obs::gnss::nv_oem6_short_header_t;
  mrpt::obs::gnss::Message_NV_OEM6_INSPVAS message;
  auto& fields = message.fields;
  fields.header.synch[0] = nv_oem6_short_header_t::SYNCH0;
  fields.header.synch[1] = nv_oem6_short_header_t::SYNCH1;
  fields.header.synch[2] = nv_oem6_short_header_t::SYNCH2;
  fields.header.msg_len = kInertialAttitudeBytes;
  fields.header.msg_id = kInertialAttitude;
  fields.lat = fix.latitude_deg;
  fields.lon = fix.longitude_deg;
  fields.hgt = fix.altitude_m;
  fields.azimuth = *fix.heading_deg;
  fields.ins_status = mrpt::obs::gnss::nv_oem6_ins_status_type::INS_SOLUTION_GOOD;
  return message;
}

mrpt::obs::CObservationGPS to_observation(const GnssFix& fix) {
  mrpt::obs::CObservationGPS observation;
  if (std::isnan(fix.altitude_m)) {
    mrpt::obs::gnss::Message_NMEA_RMC message;
    message.fields.validity_char = 'A';
    message.fields.latitude_degrees = fix.latitude_deg;
    message.fields.longitude_degrees = fix.longitude_deg;
    observation.setMsg(message);
  } else {
    mrpt::obs::gnss::Message_NMEA_GGA message;
    // 9: none that is defined, where the deviation is not known; 1 would be metres.
    constexpr std::uint8_t kUndefined = 9;
    message.fields.fix_quality =
        fix.covariance_enu ? static_cast<std::uint8_t>(sensors::gga_quality_of(*fix.covariance_enu))
                           : kUndefined;
    message.fields.latitude_degrees = fix.latitude_deg;
    message.fields.longitude_degrees = fix.longitude_deg;
    message.fields.altitude_meters = fix.altitude_m;
    message.fields.geoidal_distance = 0;
    observation.setMsg(message);
  }
  if (fix.covariance_enu) observation.setMsg(best_position(fix));
  if (fix.heading_deg) observation.setMsg(inertial_attitude(fix));
  return observation;
}

std::int32_t to_encoder(std::int64_t ticks) {
  using Limits = std::numeric_limits<std::int32_t>;
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(ticks, Limits::min(), Limits::max()));
}

mrpt::obs::CObservationOdometry to_observation(const WheelOdometry& odometry) {
  mrpt::obs::CObservationOdometry observation;
  observation.odometry =
      mrpt::poses::CPose2D(mrpt_io::to_mrpt(odometry.T_odom_body.value_or(Pose3::identity())));
  observation.hasEncodersInfo = odometry.ticks.has_value();
  if (odometry.ticks) {
    observation.encoderLeftTicks = to_encoder(odometry.ticks->left);
    observation.encoderRightTicks = to_encoder(odometry.ticks->right);
  }
  observation.hasVelocities = odometry.velocity.has_value();
  if (odometry.velocity) {
    observation.velocityLocal = {odometry.velocity->forward_mps, odometry.velocity->left_mps,
                                 odometry.velocity->yaw_rate};
  }
  return observation;
}

class RawlogWriter : public RecordingWriter {
 public:
  RawlogWriter(const fs::path& file, const RecordingInfo& info,
               const std::optional<Reference>& reference, const RawlogOptions& options)
      : file_(file),
        files_(RecordingFiles::beside(file, options.there)),
        stream_(files_.add_data().temporary_path(), options.gzip_level),
        info_(info),
        reference_(reference) {}

  void add(const sensors::Measurement& measurement) override {
    std::visit([this](const auto& held) { write(held); }, measurement);
  }

  void add_file(const std::string& name, const std::string& text) override {
    files_.write(name, text);
  }

  void commit() override {
    stream_.close();
    Sidecar sidecar = sidecar_of_whole_rig(info_, reference_, has_rings_, has_times_);
    if (sidecar.profile) sidecar.profile->intensity_full_scale = 255;
    commit_with_sidecar(sidecar, files_);
  }

 private:
  void write(const std::shared_ptr<const LidarScan>& scan) {
    const sensors::LidarProfile profile = profile_of(scan->sensor);
    const DerivedPointData derived = derive_point_data(*scan, profile);
    has_rings_ = has_rings_ || !derived.ring.empty();
    has_times_ = has_times_ || !derived.time.empty();
    auto observation = to_observation(*scan, profile, derived);
    count_rounded(*scan, derived, observation);
    write(observation, scan->stamp, scan->sensor, pose_of(scan->sensor));
  }

  void write(const std::shared_ptr<const PlanarScan>& scan) {
    Pose3 T_body_sensor = pose_of(scan->sensor);
    auto observation = to_observation(*scan, T_body_sensor);
    write(observation, scan->stamp, scan->sensor, T_body_sensor);
  }

  template <typename Sample>
  void write(const Sample& sample) {
    count_rounded(sample);
    auto observation = to_observation(sample);
    write(observation, sample.stamp, sample.sensor, pose_of(sample.sensor));
  }

  void count_rounded(const LidarScan& scan, const DerivedPointData& derived,
                     const mrpt::obs::CObservationVelodyneScan& observation) {
    const auto& cloud = observation.point_cloud;
    const mrpt::Clock::time_point stamp = mrpt_io::to_mrpt(scan.stamp);
    for (std::size_t i = 0; i < derived.time.size(); ++i) {
      const auto ticks = static_cast<double>((cloud.timestamp[i] - stamp).count());
      if (static_cast<float>(ticks * 1e-7) == derived.time[i]) continue;
      ++left_out_["point times finer than 100 ns, by scan"];
      break;
    }
    for (std::size_t i = 0; i < scan.intensity.size(); ++i) {
      if (cloud.intensity[i] == scan.intensity[i]) continue;
      ++left_out_["intensities brought to 0 to 255, by scan"];
      break;
    }
  }

  void count_rounded(const ImuSample&) {}

  void count_rounded(const GnssFix& fix) {
    if (!fix.covariance_enu) return;
    const Eigen::Matrix3d& covariance = *fix.covariance_enu;
    const Eigen::Matrix3d variances = covariance.diagonal().asDiagonal();
    if (covariance != variances) ++left_out_["correlations of fixes"];
    const Eigen::Vector3d sigmas =
        covariance.diagonal().cwiseSqrt().cast<float>().template cast<double>();
    if (sigmas.cwiseAbs2() != covariance.diagonal()) {
      ++left_out_["digits of fixes' deviations beyond those of a float"];
    }
  }

  void count_rounded(const WheelOdometry& odometry) {
    if (odometry.ticks && (to_encoder(odometry.ticks->left) != odometry.ticks->left ||
                           to_encoder(odometry.ticks->right) != odometry.ticks->right)) {
      ++left_out_["counts of pulses beyond 32 bits"];
    }
    if (!odometry.T_odom_body) return;
    const Pose3& pose = *odometry.T_odom_body;
    if (pose.translation.z() != 0 || pose.rotation(2, 2) != 1) {
      ++left_out_["heights and tilts of wheel odometry"];
    }
  }

  void write(mrpt::obs::CObservation& observation, geometry::Stamp stamp, const std::string& label,
             const Pose3& T_body_sensor) {
    observation.timestamp = mrpt_io::to_mrpt(stamp);
    if (mrpt_io::to_stamp(observation.timestamp) != stamp) {
      ++left_out_["nanoseconds of stamps below 100"];
    }
    observation.sensorLabel = label;
    observation.setSensorPose(mrpt_io::to_mrpt(T_body_sensor));
    try {
      auto archive = mrpt::serialization::archiveFrom(stream_);
      archive << observation;
    } catch (const std::exception& error) {
      throw files::OutputError(
          file_, stream_.fault().empty() ? mrpt_io::message_of(error) : stream_.fault());
    }
  }

  sensors::LidarProfile profile_of(const std::string& label) const {
    const auto* sensor = info_.rig.find(label);
    return sensor != nullptr && sensor->lidar ? *sensor->lidar : sensors::LidarProfile();
  }

  Pose3 pose_of(const std::string& label) const {
    const auto* sensor = info_.rig.find(label);
    return sensor != nullptr ? sensor->T_body_sensor : Pose3::identity();
  }

  fs::path file_;
  RecordingFiles files_;
  mrpt_io::GzOutput stream_;
  const RecordingInfo& info_;
  const std::optional<Reference> reference_;
  bool has_rings_ = false;
  bool has_times_ = false;
};

}  // namespace

std::unique_ptr<RecordingWriter> write_rawlog(const fs::path& file, const RecordingInfo& info,
                                              const std::optional<Reference>& reference,
                                              const RawlogOptions& options) {
  return std::make_unique<RawlogWriter>(file, info, reference, options);
}

}  // namespace traverse::dataset
