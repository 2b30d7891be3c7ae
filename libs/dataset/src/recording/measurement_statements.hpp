#pragma once

#include <map>
#include <string>
#include <vector>

#include "traverse/config/binder.hpp"
#include "traverse/dataset/source.hpp"
#include "traverse/sensors/gnss_fix.hpp"
#include "traverse/sensors/imu_sample.hpp"

namespace traverse::dataset {

class Statements;

/// What the numbers of an IMU are; increments are over the interval since the reading before.
enum class ForceUnit { kMetres, kG, kMilliG, kIncrement };
enum class RateUnit { kRadians, kDegrees, kIncrement };

struct ImuStatements {
  ForceUnit unit = ForceUnit::kMetres;
  RateUnit angular_rate = RateUnit::kRadians;
};
void bind(config::Binder& binder, ImuStatements& imu);

/// What the numbers of a fix are.
enum class PlaceOrder { kLatitudeFirst, kLongitudeFirst };
enum class PlaceUnit { kDegrees, kRadians, kDegreesMinutes };
enum class HeadingSense { kFromNorth, kFromEast, kCounterclockwise };
enum class HeadingUnit { kDegrees, kRadians };

struct GnssStatements {
  PlaceOrder order = PlaceOrder::kLatitudeFirst;
  PlaceUnit unit = PlaceUnit::kDegrees;
  HeadingSense heading = HeadingSense::kFromNorth;
  HeadingUnit heading_unit = HeadingUnit::kDegrees;
  double delay_s = 0;  ///< a fix is of so long before its stamp
};
void bind(config::Binder& binder, GnssStatements& gnss);

/// Turns readings as a recording holds them into measurements in the units and senses of the
/// program, by what is stated.
class StatedMeasurements {
 public:
  StatedMeasurements(const ImuStatements& imu, const GnssStatements& gnss)
      : imu_(imu), gnss_(gnss) {}

  /// False if the sample cannot be used: an increment before which there is none.
  bool apply(sensors::ImuSample& sample);
  void apply(sensors::GnssFix& fix) const;

  /// Whether readings have to be told one after the other.
  bool has_increments() const {
    return imu_.unit == ForceUnit::kIncrement || imu_.angular_rate == RateUnit::kIncrement;
  }

 private:
  ImuStatements imu_;
  GnssStatements gnss_;
  std::map<std::string, geometry::Stamp> last_;  ///< by IMU
};

/// Receivers write zeros before they have a fix.
inline bool is_nowhere(const sensors::GnssFix& fix) {
  return fix.latitude_deg == 0 && fix.longitude_deg == 0;
}
inline constexpr const char* kNoFixYet = "fix at latitude 0, longitude 0: the receiver had none";

/// A fact for each of `imu.` and `gnss.` that is stated.
void add_measurement_facts(const Statements& statements, std::vector<Fact>& facts);

}  // namespace traverse::dataset
