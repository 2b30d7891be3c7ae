#include "rawlog/rawlog_converter.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>

#include "traverse/files/input_error.hpp"
#include "traverse/mrpt_io/lidar_observations.hpp"
#include "traverse/mrpt_io/mrpt_values.hpp"
#include "traverse/sensors/gga_quality.hpp"

namespace traverse::dataset {

using geometry::Pose3;
using geometry::Stamp;
using sensors::GnssFix;
using sensors::ImuSample;
using sensors::LidarScan;
using sensors::Measurement;
using sensors::PlanarScan;
using sensors::SensorKind;
using sensors::WheelOdometry;

namespace {

constexpr const char* kActionOdometry = "odometry";

std::string class_of(const mrpt::rtti::CObject& object) {
  const std::string name = object.GetRuntimeClass()->className;
  const std::size_t colon = name.rfind(':');
  return colon == std::string::npos ? name : name.substr(colon + 1);
}

Pose3 pose_of(const mrpt::obs::CObservation& observation) {
  mrpt::poses::CPose3D pose;
  observation.getSensorPose(pose);
  return mrpt_io::to_pose(pose);
}

bool is_used(const mrpt::obs::CObservation& observation) {
  const std::string name = class_of(observation);
  for (const char* used :
       {"CObservationVelodyneScan", "CObservationPointCloud", "CObservationRotatingScan",
        "CObservation2DRangeScan", "CObservationIMU", "CObservationGPS", "CObservationOdometry"}) {
    if (name == used) return true;
  }
  return false;
}

template <typename Scan>
Measurement stamped(Scan scan, Stamp stamp, const std::string& label) {
  scan.stamp = stamp;
  scan.sensor = label;
  return std::make_shared<const Scan>(std::move(scan));
}

LidarScan with_points(LidarScan scan) {
  if (scan.empty()) throw mrpt_io::UnusableObservation("scan without points");
  return scan;
}

Eigen::Vector3d imu_vector(const mrpt::obs::CObservationIMU& observation,
                           const std::array<mrpt::obs::TIMUDataIndex, 3>& xyz) {
  Eigen::Vector3d values;
  for (int axis = 0; axis < 3; ++axis) {
    const auto index = xyz.at(static_cast<std::size_t>(axis));
    if (!mrpt_io::is_set(observation.dataIsPresent.at(index))) {
      throw mrpt_io::UnusableObservation("IMU record without three rates and three accelerations");
    }
    values[axis] = observation.rawMeasurements.at(index);
  }
  return values;
}

ImuSample imu_sample(const mrpt::obs::CObservationIMU& observation) {
  ImuSample sample;
  sample.specific_force =
      imu_vector(observation, {mrpt::obs::IMU_X_ACC, mrpt::obs::IMU_Y_ACC, mrpt::obs::IMU_Z_ACC});
  sample.angular_rate =
      imu_vector(observation, {mrpt::obs::IMU_WX, mrpt::obs::IMU_WY, mrpt::obs::IMU_WZ});
  return sample;
}

/// The message of that class, or null (MRPT's own getMsgByClassPtr() const does not compile).
template <typename Message>
const Message* find_message(const mrpt::obs::CObservationGPS& observation) {
  return observation.hasMsgClass<Message>() ? &observation.getMsgByClass<Message>() : nullptr;
}

using BestPosition = mrpt::obs::gnss::Message_NV_OEM6_BESTPOS;
using InertialAttitude = mrpt::obs::gnss::Message_NV_OEM6_INSPVAS;

/// Novatel's messages, where the receiver says that what they hold can be used; else null.
const BestPosition* good_position(const mrpt::obs::CObservationGPS& observation) {
  const auto* message = find_message<BestPosition>(observation);
  const bool is_good =
      message != nullptr &&
      message->fields.solution_stat == mrpt::obs::gnss::nv_oem6_solution_status::SOL_COMPUTED;
  return is_good ? message : nullptr;
}

const InertialAttitude* good_attitude(const mrpt::obs::CObservationGPS& observation) {
  const auto* message = find_message<InertialAttitude>(observation);
  if (message == nullptr) return nullptr;
  const auto status = static_cast<std::uint32_t>(message->fields.ins_status);
  const bool is_good = status == mrpt::obs::gnss::nv_oem6_ins_status_type::INS_SOLUTION_GOOD ||
                       status == mrpt::obs::gnss::nv_oem6_ins_status_type::INS_SOLUTION_FREE;
  return is_good ? message : nullptr;
}

/// Latitude, longitude and altitude: of the receiver's own sentence first, with the covariance of
/// its quality code, then of Novatel's messages.
GnssFix place_of(const mrpt::obs::CObservationGPS& observation) {
  GnssFix fix;
  const auto* best = good_position(observation);
  const auto* gga = find_message<mrpt::obs::gnss::Message_NMEA_GGA>(observation);
  if (gga != nullptr && (sensors::is_gga_fix(gga->fields.fix_quality) || best == nullptr)) {
    if (!sensors::is_gga_fix(gga->fields.fix_quality)) {
      throw mrpt_io::UnusableObservation(
          gga->fields.fix_quality == 0
              ? "GNSS record without a fix"
              : "GNSS record whose place was not measured (GGA quality 6 to 8)");
    }
    fix.latitude_deg = gga->fields.latitude_degrees;
    fix.longitude_deg = gga->fields.longitude_degrees;
    // NMEA: above the mean sea level, and that above the ellipsoid.
    fix.altitude_m = gga->fields.altitude_meters + gga->fields.geoidal_distance;
    fix.covariance_enu = sensors::covariance_of_gga_quality(gga->fields.fix_quality);
    return fix;
  }
  if (best != nullptr) {
    fix.latitude_deg = best->fields.lat;
    fix.longitude_deg = best->fields.lon;
    fix.altitude_m = best->fields.hgt + static_cast<double>(best->fields.undulation);
    return fix;
  }
  if (const auto* attitude = good_attitude(observation)) {
    fix.latitude_deg = attitude->fields.lat;
    fix.longitude_deg = attitude->fields.lon;
    fix.altitude_m = attitude->fields.hgt;  // above the ellipsoid
    return fix;
  }
  if (const auto* rmc = find_message<mrpt::obs::gnss::Message_NMEA_RMC>(observation)) {
    if (rmc->fields.validity_char != 'A')
      throw mrpt_io::UnusableObservation("GNSS record without a fix");
    fix.latitude_deg = rmc->fields.latitude_degrees;
    fix.longitude_deg = rmc->fields.longitude_degrees;
    fix.altitude_m = std::numeric_limits<double>::quiet_NaN();
    return fix;  // its course over ground is not a heading
  }
  if (find_message<BestPosition>(observation) != nullptr ||
      find_message<InertialAttitude>(observation) != nullptr) {
    throw mrpt_io::UnusableObservation("GNSS record without a fix");
  }
  throw mrpt_io::UnusableObservation("GNSS record without GGA, RMC, BESTPOS or INSPVAS");
}

/// A fix, and whether GGA's quality code alone tells how exact it is.
struct RatedFix {
  GnssFix fix;
  bool is_by_quality = false;
};

RatedFix gnss_fix(const mrpt::obs::CObservationGPS& observation) {
  GnssFix fix = place_of(observation);
  bool is_by_quality = fix.covariance_enu.has_value();
  if (const auto* best = good_position(observation)) {
    const Eigen::Vector3d sigmas_enu(best->fields.lon_sigma, best->fields.lat_sigma,
                                     best->fields.hgt_sigma);
    if (sigmas_enu.allFinite() && sigmas_enu.minCoeff() > 0) {
      fix.covariance_enu = Eigen::Matrix3d(sigmas_enu.cwiseAbs2().asDiagonal());
      is_by_quality = false;
    }
  }
  if (const auto* attitude = good_attitude(observation)) {
    const double azimuth = attitude->fields.azimuth;  // packed: a reference would be misaligned
    if (std::isfinite(azimuth)) fix.heading_deg = azimuth;
  }
  return {fix, is_by_quality};
}

WheelOdometry wheel_odometry(const mrpt::obs::CObservationOdometry& observation) {
  WheelOdometry odometry;
  odometry.T_odom_body = mrpt_io::to_pose(mrpt::poses::CPose3D(observation.odometry));
  if (mrpt_io::is_set(observation.hasEncodersInfo)) {
    odometry.ticks = {observation.encoderLeftTicks, observation.encoderRightTicks};
  }
  if (mrpt_io::is_set(observation.hasVelocities)) {
    const auto& v = observation.velocityLocal;
    odometry.velocity = {v.vx, v.vy, v.omega};
  }
  return odometry;
}

}  // namespace

RawlogConverter::RawlogConverter(RawlogSensors& sensors, NamedPoints& named_points,
                                 std::string external_folder)
    : sensors_(sensors),
      named_points_(named_points),
      external_folder_(std::move(external_folder)),
      stated_(sensors.statements()->imu, sensors.statements()->gnss) {
  if (stated_.has_increments()) {
    throw sensors.statements().error("imu.unit", "rates and forces: a rawlog holds no increments",
                                     "increment");
  }
}

ConvertedRecord RawlogConverter::convert(const mrpt_io::RawlogRecord& record) {
  ConvertedRecord result;
  if (auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(record.object)) {
    for (const auto& observation : *frame) {
      if (observation) add_observation(*observation, record, result);
    }
  } else if (auto actions =
                 std::dynamic_pointer_cast<mrpt::obs::CActionCollection>(record.object)) {
    add_actions(*actions, record, result);
  } else if (auto observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(record.object)) {
    add_observation(*observation, record, result);
  } else {
    result.skipped.push_back({"class not used: " + record.class_name, record.place});
  }
  return result;
}

void RawlogConverter::add_observation(mrpt::obs::CObservation& observation,
                                      const mrpt_io::RawlogRecord& record,
                                      ConvertedRecord& result) {
  try {
    const auto stamp = mrpt_io::to_stamp(observation.timestamp);
    if (stamp && state_.odometry_waits) flush_odometry(*stamp, result);
    if (!is_used(observation)) {
      throw mrpt_io::UnusableObservation("class not used: " + class_of(observation));
    }
    if (!stamp)
      throw mrpt_io::UnusableObservation("no stamp in a record of " + class_of(observation));
    result.measurements.push_back(measurement_from(observation, *stamp, record));
  } catch (const mrpt_io::UnusableObservation& error) {
    result.skipped.push_back({error.what(), record.place});
  } catch (const files::InputError&) {
    throw;  // what is stated about the sensor is wrong, not the record
  } catch (const std::exception& error) {
    result.skipped.push_back(
        {fmt::format("{} cannot be used: {}", class_of(observation), mrpt_io::message_of(error)),
         record.place});
  }
}

Measurement RawlogConverter::measurement_from(mrpt::obs::CObservation& observation, Stamp stamp,
                                              const mrpt_io::RawlogRecord& record) {
  const std::string& name = observation.sensorLabel;
  const Pose3 T_body_sensor = pose_of(observation);

  if (auto* velodyne = dynamic_cast<mrpt::obs::CObservationVelodyneScan*>(&observation)) {
    LidarScan scan = with_points(mrpt_io::take_scan(*velodyne));
    const auto& lidar = sensors_.lidar(name, T_body_sensor, mrpt_io::profile_of(*velodyne, scan));
    return stamped(std::move(scan), stamp, lidar.label);
  }
  if (auto* cloud = dynamic_cast<mrpt::obs::CObservationPointCloud*>(&observation)) {
    LidarScan scan = with_points(mrpt_io::take_scan(*cloud, external_folder_));
    const auto* fields = mrpt_io::named_fields(*cloud);
    if (fields != nullptr) {
      scan = named_points_.interpret(*fields, std::move(scan), stamp, name, record);
    }
    const auto& lidar =
        sensors_.lidar(name, T_body_sensor, mrpt_io::profile_of(*cloud, scan), fields != nullptr);
    return stamped(std::move(scan), stamp, lidar.label);
  }
  if (const auto* rotating = dynamic_cast<mrpt::obs::CObservationRotatingScan*>(&observation)) {
    if (rotating->rangeImage.rows() == 1) {
      return stamped(mrpt_io::planar_scan(*rotating), stamp,
                     sensors_.label_of(SensorKind::kPlanarLaser, name, T_body_sensor));
    }
    const auto& lidar = sensors_.lidar(name, T_body_sensor, mrpt_io::profile_of(*rotating));
    return stamped(with_points(mrpt_io::take_scan(*rotating, lidar.lidar->elevations_deg)), stamp,
                   lidar.label);
  }
  if (const auto* laser = dynamic_cast<mrpt::obs::CObservation2DRangeScan*>(&observation)) {
    return stamped(mrpt_io::planar_scan(*laser), stamp,
                   sensors_.label_of(SensorKind::kPlanarLaser, name, T_body_sensor));
  }
  if (const auto* imu = dynamic_cast<mrpt::obs::CObservationIMU*>(&observation)) {
    ImuSample sample = imu_sample(*imu);
    sample.stamp = stamp;
    sample.sensor = sensors_.label_of(SensorKind::kImu, name, T_body_sensor);
    stated_.apply(sample);
    return sample;
  }
  if (const auto* gnss = dynamic_cast<mrpt::obs::CObservationGPS*>(&observation)) {
    auto [fix, is_by_quality] = gnss_fix(*gnss);
    fix.stamp = stamp;
    fix.sensor = sensors_.label_of(SensorKind::kGnss, name, T_body_sensor);
    stated_.apply(fix);
    if (is_nowhere(fix)) throw mrpt_io::UnusableObservation(kNoFixYet);
    if (is_by_quality) sensors_.note_gga_quality(*fix.covariance_enu);
    return std::move(fix);
  }
  if (const auto* wheels = dynamic_cast<mrpt::obs::CObservationOdometry*>(&observation)) {
    WheelOdometry odometry = wheel_odometry(*wheels);
    odometry.stamp = stamp;
    odometry.sensor = sensors_.label_of(SensorKind::kWheels, name, T_body_sensor);
    return odometry;
  }
  throw std::logic_error("is_used() accepts a class that nothing reads");
}

void RawlogConverter::add_actions(const mrpt::obs::CActionCollection& actions,
                                  const mrpt_io::RawlogRecord& record, ConvertedRecord& result) {
  for (const auto& action : actions) {
    const auto* movement = dynamic_cast<const mrpt::obs::CActionRobotMovement2D*>(action.get());
    const bool is_odometry =
        movement != nullptr &&
        movement->estimationMethod == mrpt::obs::CActionRobotMovement2D::emOdometry;
    if (!is_odometry) {
      const std::string name = action.get() != nullptr ? class_of(*action) : "none";
      result.skipped.push_back({"action not used: " + name, record.place});
      continue;
    }
    add_up(*movement);
    state_.odometry_waits = true;
    if (const auto stamp = mrpt_io::to_stamp(movement->timestamp)) flush_odometry(*stamp, result);
  }
}

void RawlogConverter::add_up(const mrpt::obs::CActionRobotMovement2D& action) {
  const Pose3 T_before_after =
      mrpt_io::to_pose(mrpt::poses::CPose3D(action.rawOdometryIncrementReading));
  state_.odometry.T_odom_body =
      state_.odometry.T_odom_body.value_or(Pose3::identity()) * T_before_after;
  if (mrpt_io::is_set(action.hasEncodersInfo)) {
    WheelOdometry::Ticks ticks = state_.odometry.ticks.value_or(WheelOdometry::Ticks());
    ticks.left += action.encoderLeftTicks;
    ticks.right += action.encoderRightTicks;
    state_.odometry.ticks = ticks;
  }
  state_.odometry.velocity.reset();
  if (mrpt_io::is_set(action.hasVelocities)) {
    const auto& v = action.velocityLocal;
    state_.odometry.velocity = {v.vx, v.vy, v.omega};
  }
}

void RawlogConverter::flush_odometry(Stamp stamp, ConvertedRecord& result) {
  state_.odometry.stamp = stamp;
  state_.odometry.sensor =
      sensors_.label_of(SensorKind::kWheels, kActionOdometry, Pose3::identity());
  result.measurements.emplace_back(state_.odometry);
  state_.odometry_waits = false;
}

}  // namespace traverse::dataset
