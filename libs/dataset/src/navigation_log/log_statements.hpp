#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "traverse/config/binder.hpp"

namespace traverse::dataset {

enum class AngularUnit { kRadians, kDegrees };
enum class PulseCount { kInterval, kCumulative };

/// How a text log writes its numbers.
struct LogStatements {
  AngularUnit angular_rate = AngularUnit::kRadians;
  PulseCount pulses = PulseCount::kInterval;
  double time_unit_s = 1;
};
void bind(config::Binder& binder, LogStatements& log);

/// The columns of one sensor in a CSV file with a header line.
struct CsvColumns {
  std::string file;  ///< empty: the recording has no such sensor
  std::string time = "t";
  std::string columns;  ///< names, blanks between
  /// Of a sensor with a clock of its own whose readings are stamped when they arrive; 0: the stamps
  /// are as good as it gets [s].
  double period_s = 0;
};

/// The files that make a recording.
struct CsvStatements {
  CsvColumns gyro;           ///< x y z [rad/s, or as `angular_rate` says]
  CsvColumns accelerometer;  ///< x y z [m/s^2]
  CsvColumns gnss;           ///< latitude, longitude [deg], altitude [m]; heading [deg] if there
  CsvColumns wheels;         ///< one or more forward speeds [m/s], of which the mean is taken
  CsvColumns reference;      ///< x y z qw qx qy qz of the body, earth-centred earth-fixed [m]
  /// Of the axes of the reference's quaternion in the body; [3] or empty.
  std::vector<double> reference_roll_pitch_yaw_deg;
  AngularUnit angular_rate = AngularUnit::kRadians;
  double time_unit_s = 1;
};
void bind(config::Binder& binder, CsvStatements& csv);

/// For an error about a time that is out of range: "'1700000000000000000', nanoseconds if it is a
/// Unix time; say so with --recording log.time_unit_s=1e-9".
std::string time_out_of_range(std::string_view time, std::string_view key);

}  // namespace traverse::dataset
