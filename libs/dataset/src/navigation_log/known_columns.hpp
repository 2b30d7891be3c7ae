#pragma once

#include <filesystem>
#include <string>

#include "navigation_log/log_statements.hpp"

namespace traverse::dataset {

/// The tables of a folder whose headers tell what they hold, and which those are.
struct KnownTables {
  CsvStatements csv;
  std::string reason;  ///< empty: none was found
  std::string
      not_understood;  ///< a table that is called as one but whose columns are not; or empty
};

/// imu.csv, imu0/data.csv (EuRoC, also under mav0), gnss.csv or gps.csv, wheels.csv or odom.csv
/// whose header names the columns as is usual: t or timestamp; gx gy gz, wx wy wz, gyro_x,
/// angular_velocity_x or w_RS_S_x; ax ay az, acc_x, linear_acceleration_x or a_RS_S_x; lat lon alt
/// (a heading must be stated); v, speed or left right. Any table with EuRoC's header is an IMU's.
KnownTables known_tables(const std::filesystem::path& folder);

}  // namespace traverse::dataset
