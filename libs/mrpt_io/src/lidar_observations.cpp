#include "traverse/mrpt_io/lidar_observations.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <mrpt/io/lazy_load_path.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/VelodyneCalibration.h>

#include "traverse/mrpt_io/gz_stream.hpp"
#include "traverse/mrpt_io/mrpt_values.hpp"
#include "traverse/packets/velodyne.hpp"

#include "allocation_guard.hpp"
#include "later_records.hpp"

namespace traverse::mrpt_io {

using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CObservationPointCloud;
using mrpt::obs::CObservationRotatingScan;
using mrpt::obs::CObservationVelodyneScan;
using mrpt::obs::VelodyneCalibration;
using sensors::LidarProfile;
using sensors::LidarScan;
using sensors::PlanarScan;

namespace {

constexpr float kNoReturn = std::numeric_limits<float>::quiet_NaN();
constexpr double kDegreesPerRadian = 180 / std::numbers::pi;

std::vector<double> elevations_deg(const VelodyneCalibration& calibration) {
  std::vector<double> elevations;
  for (const auto& laser : calibration.laser_corrections) {
    elevations.push_back(std::asin(laser.sinVertCorrection) * kDegreesPerRadian);
  }
  return elevations;
}

using Packet = CObservationVelodyneScan::TVelodyneRawPacket;
static_assert(sizeof(Packet) == packets::kVelodynePacketBytes);

packets::VelodynePacket bytes_of(const Packet& packet) {
  return packets::VelodynePacket(reinterpret_cast<const std::uint8_t*>(&packet), sizeof(Packet));
}

const VelodyneCalibration& default_calibration(std::uint8_t model) {
  constexpr std::uint8_t kHdl32 = 0x21;
  constexpr std::uint8_t kVlp16 = 0x22;
  if (model == kVlp16) return VelodyneCalibration::LoadDefaultCalibration("VLP16");
  if (model == kHdl32) return VelodyneCalibration::LoadDefaultCalibration("HDL32");
  throw UnusableObservation(
      fmt::format("Velodyne packets of model 0x{:x} without a calibration", model));
}

/// MRPT 2.5.8 stores degrees where it has read XML and radians where it has read YAML; the sine
/// that it stores beside the elevation tells which.
std::vector<packets::VelodyneLaser> lasers_of(const VelodyneCalibration& calibration) {
  const auto& stored = calibration.laser_corrections;
  const bool is_degrees = std::any_of(stored.begin(), stored.end(), [](const auto& laser) {
    return std::abs(std::sin(laser.verticalCorrection) - laser.sinVertCorrection) > 1e-3;
  });
  std::vector<packets::VelodyneLaser> lasers;
  for (const auto& laser : stored) {
    lasers.push_back({std::asin(laser.sinVertCorrection),
                      laser.azimuthCorrection / (is_degrees ? kDegreesPerRadian : 1),
                      laser.distanceCorrection, laser.verticalOffsetCorrection,
                      laser.horizontalOffsetCorrection});
  }
  return lasers;
}

packets::VelodyneDecoder decoder_for(const VelodyneCalibration& calibration) {
  using packets::VelodyneModel;
  const auto lasers = lasers_of(calibration);
  switch (lasers.size()) {
    case 16:
      return {VelodyneModel::kVlp16, lasers};
    case 32:
      return {VelodyneModel::kHdl32e, lasers};
    case 64:
      return {VelodyneModel::kHdl64e, lasers};
    default:
      throw UnusableObservation(
          fmt::format("Velodyne packets with a calibration of {} lasers, expected 16, 32 or 64",
                      lasers.size()));
  }
}

/// By our own decoder: that of MRPT 2.5.8 takes 16 of the 32 returns of a block, and gives all
/// points of a packet one time.
LidarScan decode_packets(CObservationVelodyneScan& observation) {
  std::erase_if(observation.scan_packets,
                [](const Packet& packet) { return !packets::is_velodyne_data(bytes_of(packet)); });
  if (observation.scan_packets.empty()) {
    throw UnusableObservation("Velodyne scan without points or whole packets");
  }
  const Packet& first = observation.scan_packets.front();
  if (observation.calibration.laser_corrections.empty()) {
    observation.calibration = default_calibration(first.velodyne_model_ID);
  }
  const packets::VelodyneDecoder decoder = decoder_for(observation.calibration);
  LidarScan scan;
  for (const Packet& packet : observation.scan_packets) {
    decoder.append(bytes_of(packet), packets::velodyne_microseconds(bytes_of(first)), scan);
  }
  return scan;
}

/// Through unsigned numbers, because stamps in a damaged file may be as far apart as they can.
float seconds_after(mrpt::Clock::time_point stamp, mrpt::Clock::time_point time) {
  const auto ticks =
      static_cast<std::int64_t>(static_cast<std::uint64_t>(time.time_since_epoch().count()) -
                                static_cast<std::uint64_t>(stamp.time_since_epoch().count()));
  return static_cast<float>(static_cast<double>(ticks) * 1e-7);
}

/// Takes no more memory than the external file holds, whatever it states.
void load_guarded(const CObservationPointCloud& observation, const std::string& external_folder) {
  std::optional<GzInput> file;
  AllocationGuard guard([&](std::uint64_t count) {
    if (!file) {
      file.emplace(std::filesystem::path(external_folder) / observation.getExternalStorageFile());
    }
    return file->reaches(count);
  });
  try {
    observation.load();
  } catch (const std::exception&) {
    if (const std::string refusal = guard.refusal(); !refusal.empty()) {
      throw std::runtime_error(refusal);
    }
    throw;
  }
}

/// Rings and times of the names that MRPT itself gives them.
void take_own_fields(const std::vector<NamedField>& fields, LidarScan& scan) {
  for (const NamedField& field : fields) {
    std::visit(
        [&](const auto& values) {
          using Number = typename std::decay_t<decltype(values)>::value_type;
          if constexpr (std::is_floating_point_v<Number>) {
            if (field.name != "t" && field.name != "time") return;
            scan.time.clear();
            for (const Number value : values) scan.time.push_back(static_cast<float>(value));
          } else {
            if (field.name != "ring") return;
            scan.ring.clear();
            for (const Number value : values) {
              scan.ring.push_back(static_cast<std::uint16_t>(value));
            }
          }
        },
        field.values);
  }
}

/// A 2-D scanner's or a range image's columns.
struct Columns {
  std::size_t count = 0;
  double first_azimuth = 0;
  double step = 0;
};

Columns columns_of(const CObservationRotatingScan& observation) {
  const auto rows = static_cast<std::size_t>(observation.rangeImage.rows());
  Columns columns{static_cast<std::size_t>(observation.rangeImage.cols()), observation.startAzimuth,
                  0};
  double span = observation.azimuthSpan;
  if (observation.lidarModel == "VLP-16" || observation.lidarModel == "HDL-32E") {
    columns.count /= std::max<std::size_t>(rows, 1);
    columns.first_azimuth = -columns.first_azimuth;
    span = -span;
  }
  // A single row spans from its first to its last column; an image goes on where it began.
  const std::size_t steps = rows == 1 && columns.count > 1 ? columns.count - 1 : columns.count;
  columns.step = steps == 0 ? 0 : span / static_cast<double>(steps);
  return columns;
}

}  // namespace

LidarScan take_scan(CObservationVelodyneScan& observation) {
  // Points that are stored beside the packets were made by MRPT's decoder.
  if (!observation.scan_packets.empty() || observation.point_cloud.size() == 0) {
    return decode_packets(observation);
  }
  auto& cloud = observation.point_cloud;
  LidarScan scan;
  scan.x = std::move(cloud.x);
  scan.y = std::move(cloud.y);
  scan.z = std::move(cloud.z);
  scan.intensity.assign(cloud.intensity.begin(), cloud.intensity.end());
  scan.ring.assign(cloud.laser_id.begin(), cloud.laser_id.end());
  scan.time.reserve(cloud.timestamp.size());
  for (const auto& time : cloud.timestamp) {
    scan.time.push_back(seconds_after(observation.timestamp, time));
  }
  return scan;
}

LidarScan take_scan(CObservationPointCloud& observation, const std::string& external_folder) {
  mrpt::io::setLazyLoadPathBase(external_folder);  // one for the whole program, so set each time
  try {
    load_guarded(observation, external_folder);
  } catch (const std::exception& error) {
    throw UnusableObservation("external point cloud cannot be loaded: " + message_of(error));
  }
  if (!observation.pointcloud) throw UnusableObservation("point cloud is missing");
  const mrpt::maps::CPointsMap& cloud = *observation.pointcloud;
  LidarScan scan;
  scan.x.assign(cloud.getPointsBufferRef_x().begin(), cloud.getPointsBufferRef_x().end());
  scan.y.assign(cloud.getPointsBufferRef_y().begin(), cloud.getPointsBufferRef_y().end());
  scan.z.assign(cloud.getPointsBufferRef_z().begin(), cloud.getPointsBufferRef_z().end());
  const auto* later = dynamic_cast<const LaterPoints*>(&cloud);
  if (later != nullptr) take_own_fields(later->fields, scan);
  const auto* xyzi = dynamic_cast<const mrpt::maps::CPointsMapXYZI*>(&cloud);
  if (xyzi != nullptr && (later == nullptr || later->has_intensity)) {
    const auto& intensity = xyzi->getPointsBufferRef_intensity();
    scan.intensity.assign(intensity.begin(), intensity.end());
  }
  return scan;
}

const std::vector<NamedField>* named_fields(const CObservationPointCloud& observation) {
  const auto* later = dynamic_cast<const LaterPoints*>(observation.pointcloud.get());
  return later == nullptr ? nullptr : &later->fields;
}

LidarScan take_scan(const CObservationRotatingScan& observation,
                    const std::vector<double>& elevations_deg) {
  const auto& image = observation.rangeImage;
  const auto rows = static_cast<std::size_t>(image.rows());
  if (elevations_deg.size() != rows) {
    throw UnusableObservation(
        fmt::format("range image of {} rows without as many lidar.elevations_deg", rows));
  }
  const bool has_intensity = observation.intensityImage.rows() == image.rows() &&
                             observation.intensityImage.cols() == image.cols();
  const Columns columns = columns_of(observation);
  LidarScan scan;
  for (std::size_t column = 0; column < columns.count; ++column) {
    const double azimuth = columns.first_azimuth + columns.step * static_cast<double>(column);
    for (std::size_t row = 0; row < rows; ++row) {
      if (image(row, column) == 0) continue;  // no return
      const double range = image(row, column) * observation.rangeResolution;
      const double elevation = elevations_deg[row] / kDegreesPerRadian;
      scan.x.push_back(static_cast<float>(range * std::cos(elevation) * std::cos(azimuth)));
      scan.y.push_back(static_cast<float>(range * std::cos(elevation) * std::sin(azimuth)));
      scan.z.push_back(static_cast<float>(range * std::sin(elevation)));
      scan.ring.push_back(static_cast<std::uint16_t>(row));
      if (has_intensity) scan.intensity.push_back(observation.intensityImage(row, column));
      if (observation.sweepDuration > 0) {
        scan.time.push_back(
            static_cast<float>(observation.sweepDuration * static_cast<double>(column) /
                               static_cast<double>(columns.count)));
      }
    }
  }
  return scan;
}

PlanarScan planar_scan(const CObservation2DRangeScan& observation) {
  PlanarScan scan;
  const std::size_t count = observation.getScanSize();
  const bool counterclockwise = is_set(observation.rightToLeft);
  const double aperture = counterclockwise ? observation.aperture : -observation.aperture;
  scan.first_azimuth = -aperture / 2;
  scan.azimuth_step = count > 1 ? aperture / static_cast<double>(count - 1) : 0;
  scan.max_range_m = observation.maxRange;
  for (std::size_t i = 0; i < count; ++i) {
    scan.ranges_m.push_back(observation.getScanRangeValidity(i) ? observation.getScanRange(i)
                                                                : kNoReturn);
  }
  return scan;
}

PlanarScan planar_scan(const CObservationRotatingScan& observation) {
  const Columns columns = columns_of(observation);
  PlanarScan scan;
  scan.first_azimuth = columns.first_azimuth;
  scan.azimuth_step = columns.step;
  scan.max_range_m = observation.maxRange;
  for (std::size_t i = 0; i < columns.count; ++i) {
    const std::uint16_t units = observation.rangeImage(0, i);
    scan.ranges_m.push_back(units == 0 ? kNoReturn
                                       : static_cast<float>(units * observation.rangeResolution));
  }
  return scan;
}

LidarProfile profile_of(const CObservationVelodyneScan& observation, const LidarScan& scan) {
  LidarProfile profile;
  profile.elevations_deg = elevations_deg(observation.calibration);
  profile.rings = static_cast<int>(profile.elevations_deg.size());
  if (profile.rings == 0 && !scan.ring.empty()) {
    profile.rings = *std::max_element(scan.ring.begin(), scan.ring.end()) + 1;
  }
  profile.min_range_m = observation.minRange;
  profile.max_range_m = observation.maxRange;
  profile.time_source = scan.time.empty() ? sensors::TimeSource::kNone : sensors::TimeSource::kData;
  return profile;
}

LidarProfile profile_of(const CObservationRotatingScan& observation) {
  LidarProfile profile;
  profile.name = observation.lidarModel;
  profile.rings = static_cast<int>(observation.rangeImage.rows());
  if (observation.lidarModel == "VLP-16") {
    profile.elevations_deg = elevations_deg(VelodyneCalibration::LoadDefaultCalibration("VLP16"));
  } else if (observation.lidarModel == "HDL-32E") {
    profile.elevations_deg = elevations_deg(VelodyneCalibration::LoadDefaultCalibration("HDL32"));
  }
  profile.min_range_m = observation.minRange;
  profile.max_range_m = observation.maxRange;
  profile.sweep_s = observation.sweepDuration > 0 ? observation.sweepDuration : profile.sweep_s;
  profile.time_source =
      observation.sweepDuration > 0 ? sensors::TimeSource::kData : sensors::TimeSource::kNone;
  return profile;
}

LidarProfile profile_of(const CObservationPointCloud&, const LidarScan& scan) {
  LidarProfile profile;
  profile.time_source = scan.time.empty() ? sensors::TimeSource::kNone : sensors::TimeSource::kData;
  if (!scan.ring.empty()) {
    profile.rings = *std::max_element(scan.ring.begin(), scan.ring.end()) + 1;
  }
  const auto brightest = std::max_element(scan.intensity.begin(), scan.intensity.end());
  if (brightest != scan.intensity.end() && *brightest <= 1) profile.intensity_full_scale = 1;
  return profile;
}

}  // namespace traverse::mrpt_io
