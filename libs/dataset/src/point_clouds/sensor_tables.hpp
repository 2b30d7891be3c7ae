#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "traverse/sensors/measurement.hpp"
#include "traverse/sensors/rig.hpp"

namespace traverse::dataset {

/// The tables beside a folder's scans, of the first IMU, receiver and wheels of a rig: imu.csv,
/// gnss.csv and wheels.csv, with columns that are known by their names.
class SensorTables {
 public:
  /// Both must outlive it. \param left_out takes what a table has no place for
  SensorTables(const sensors::Rig& rig, std::map<std::string, std::size_t>& left_out);

  /// False for what no table is for: scans, and further sensors of a kind.
  bool add(const sensors::Measurement& measurement);

  /// By name, with their headers.
  const std::map<std::string, std::string>& files() const { return files_; }

 private:
  bool is_first(sensors::SensorKind kind, const std::string& label) const;
  void add_row(const char* file, const char* header, const std::string& row);
  bool add(const sensors::ImuSample& sample);
  bool add(const sensors::GnssFix& fix);
  bool add(const sensors::WheelOdometry& reading);

  const sensors::Rig& rig_;
  std::map<std::string, std::size_t>& left_out_;
  std::map<std::string, std::string> files_;
};

}  // namespace traverse::dataset
