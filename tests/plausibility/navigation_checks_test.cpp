#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/geometry/angle.hpp"

#include "plausibility/made_recording.hpp"

namespace traverse::plausibility {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using namespace traverse::testing;  // made recordings
using sensors::GnssFix;
using sensors::ImuSample;
using sensors::WheelOdometry;

/// One fault, planted in a drive that is right.
struct Fault {
  const char* name;
  void (*plant)(MadeRecording& recording);
  std::vector<std::string> codes;
  const char* statement;  // or a part of it
  Severity severity;
};

std::ostream& operator<<(std::ostream& out, const Fault& fault) { return out << fault.name; }

void scale_force(MadeRecording& recording, double factor) {
  recording.for_each<ImuSample>([&](ImuSample& s) { s.specific_force *= factor; });
}
void scale_rate(MadeRecording& recording, double factor) {
  recording.for_each<ImuSample>([&](ImuSample& s) { s.angular_rate *= factor; });
}
void move_fixes(MadeRecording& recording, double seconds) {
  recording.for_each<GnssFix>([&](GnssFix& f) { f.stamp = geometry::shifted(f.stamp, seconds); });
  recording.sort();
}
double with_minutes(double degrees) {
  const double whole = std::trunc(degrees);
  return whole + (degrees - whole) * 60 / 100;
}

const std::vector<Fault> kFaults{
    {"force_in_g",
     [](MadeRecording& r) { scale_force(r, 1 / 9.80665); },
     {"imu_in_g"},
     "imu.unit=g",
     Severity::kRefuse},
    {"force_in_mg",
     [](MadeRecording& r) { scale_force(r, 1000 / 9.80665); },
     {"imu_in_mg"},
     "imu.unit=mg",
     Severity::kRefuse},
    {"force_increments",
     [](MadeRecording& r) { scale_force(r, 0.01); },
     {"imu_increments"},
     "imu.unit=increment",
     Severity::kRefuse},
    {"force_in_feet",
     [](MadeRecording& r) { scale_force(r, 3.28); },
     {"imu_gravity"},
     "",
     Severity::kRefuse},
    {"force_without_gravity",
     [](MadeRecording& r) {
       r.for_each<ImuSample>([](ImuSample& s) { s.specific_force.z() -= 9.81; });
     },
     {"imu_without_gravity"},
     "",
     Severity::kRefuse},
    {"gyro_in_degrees",
     [](MadeRecording& r) { scale_rate(r, 1 / geometry::kDegree); },
     {"gyro_deg"},
     "log.angular_rate=deg",
     Severity::kRefuse},
    {"gyro_taken_for_degrees",
     [](MadeRecording& r) { scale_rate(r, geometry::kDegree); },
     {"gyro_small"},
     "log.angular_rate=rad",
     Severity::kRefuse},
    {"gyro_increments",
     [](MadeRecording& r) { scale_rate(r, 0.01); },
     {"gyro_small"},
     "imu.angular_rate=increment",
     Severity::kRefuse},
    {"gyro_mirrored",
     [](MadeRecording& r) {
       r.for_each<ImuSample>([](ImuSample& s) { s.angular_rate.z() *= -1; });
     },
     {"gyro_mirrored"},
     "roll_pitch_yaw_deg",
     Severity::kRefuse},
    {"imu_upside_down",
     [](MadeRecording& r) {
       r.for_each<ImuSample>([](ImuSample& s) {
         for (auto* v : {&s.angular_rate, &s.specific_force}) v->tail<2>() *= -1;
       });
     },
     {"imu_not_upright", "gyro_mirrored"},
     "roll_pitch_yaw_deg=[180, 0, 0]",
     Severity::kWarn},
    {"imu_in_milliseconds",
     [](MadeRecording& r) {
       r.measurements.resize(r.measurements.size() / 4);
       for (auto& m : r.measurements) {
         std::visit(
             [](auto& held) {
               if constexpr (requires { held.stamp; }) held.stamp.nanoseconds *= 1000;
             },
             m);
       }
     },
     {"imu_interval"},
     "log.time_unit_s=0.001",
     Severity::kRefuse},
    {"pulses_cumulative",
     [](MadeRecording& r) {
       WheelOdometry::Ticks sum;
       r.for_each<WheelOdometry>([&](WheelOdometry& w) {
         sum = {sum.left + w.ticks->left, sum.right + w.ticks->right};
         w.ticks = sum;
       });
     },
     {"wheels_cumulative"},
     "log.pulses=cumulative",
     Severity::kRefuse},
    {"pulses_of_intervals",
     [](MadeRecording& r) {
       WheelOdometry::Ticks last;
       r.for_each<WheelOdometry>([&](WheelOdometry& w) {
         const WheelOdometry::Ticks now = *w.ticks;
         w.ticks = {now.left - last.left, now.right - last.right};
         last = now;
       });
     },
     {"wheels_interval"},
     "log.pulses=interval",
     Severity::kRefuse},
    {"wheels_too_large",
     [](MadeRecording& r) {
       r.info.rig.sensors[2].encoder->left_m_per_pulse *= 1.5;
       r.info.rig.sensors[2].encoder->right_m_per_pulse *= 1.5;
     },
     {"wheels_scale"},
     "left_m_per_pulse=0.0018",
     Severity::kWarn},
    {"wheels_backwards",
     [](MadeRecording& r) {
       r.for_each<WheelOdometry>([](WheelOdometry& w) {
         w.ticks = {-w.ticks->left, -w.ticks->right};
       });
     },
     {"wheels_backwards"},
     "left_m_per_pulse=-",
     Severity::kWarn},
    {"places_swapped",
     [](MadeRecording& r) {
       r.for_each<GnssFix>([](GnssFix& f) { std::swap(f.latitude_deg, f.longitude_deg); });
     },
     {"gnss_swapped"},
     "gnss.order=longitude_latitude",
     Severity::kWarn},
    {"places_in_radians",
     [](MadeRecording& r) {
       r.for_each<GnssFix>([](GnssFix& f) {
         f.latitude_deg *= geometry::kDegree;
         f.longitude_deg *= geometry::kDegree;
       });
     },
     {"gnss_radians"},
     "gnss.unit=rad",
     Severity::kRefuse},
    {"places_in_minutes",
     [](MadeRecording& r) {
       r.for_each<GnssFix>([](GnssFix& f) {
         f.latitude_deg = with_minutes(f.latitude_deg);
         f.longitude_deg = with_minutes(f.longitude_deg);
       });
     },
     {"gnss_ddmm"},
     "gnss.unit=ddmm",
     Severity::kRefuse},
    {"first_places_zero",
     [](MadeRecording& r) {
       int count = 0;
       r.for_each<GnssFix>([&](GnssFix& f) {
         if (++count <= 5) f.latitude_deg = f.longitude_deg = f.altitude_m = 0;
       });
     },
     {"gnss_zero"},
     "",
     Severity::kWarn},
    {"heading_from_east",
     [](MadeRecording& r) {
       r.for_each<GnssFix>([](GnssFix& f) { f.heading_deg = 90 - *f.heading_deg; });
     },
     {"gnss_heading_from_east"},
     "gnss.heading=from_east",
     Severity::kWarn},
    {"heading_counterclockwise",
     [](MadeRecording& r) {
       r.for_each<GnssFix>([](GnssFix& f) { f.heading_deg = -*f.heading_deg; });
     },
     {"gnss_heading_counterclockwise"},
     "gnss.heading=counterclockwise",
     Severity::kWarn},
    {"heading_in_radians",
     [](MadeRecording& r) {
       r.for_each<GnssFix>([](GnssFix& f) { *f.heading_deg *= geometry::kDegree; });
     },
     {"gnss_heading_rad"},
     "gnss.heading_unit=rad",
     Severity::kWarn},
    {"heading_backwards",
     [](MadeRecording& r) { r.for_each<GnssFix>([](GnssFix& f) { *f.heading_deg += 180; }); },
     {"gnss_heading_offset"},
     "heading_offset_deg=",
     Severity::kWarn},
    {"heading_of_a_baseline_across",
     [](MadeRecording& r) { r.for_each<GnssFix>([](GnssFix& f) { *f.heading_deg -= 90; }); },
     {"gnss_heading_offset"},
     "heading_offset_deg=",
     Severity::kWarn},
    {"fixes_late",
     [](MadeRecording& r) { move_fixes(r, 0.4); },
     {"gnss_late"},
     "gnss.delay_s=0.",
     Severity::kWarn},
    {"fixes_on_another_clock",
     [](MadeRecording& r) { move_fixes(r, 18); },
     {"gnss_late"},
     "gnss.delay_s=1",
     Severity::kRefuse},
    {"fixes_early",
     [](MadeRecording& r) { move_fixes(r, -1.5); },
     {"gnss_late"},
     "gnss.delay_s=-1.",
     Severity::kRefuse},
};

class PlantedFault : public ::testing::TestWithParam<Fault> {};

TEST_P(PlantedFault, IsFoundAndNothingElse) {
  for (const double gnss_sigma_m : {0.01, 0.05}) {
    SimulatedSensors sensors;
    sensors.gnss_sigma_m = gnss_sigma_m;
    sensors.heading_sigma_deg = 0.3;
    MadeRecording recording = made_drive(sensors);
    GetParam().plant(recording);
    const auto findings = findings_in(recording);
    ASSERT_EQ(codes_of(findings), GetParam().codes) << texts_of(findings);
    EXPECT_THAT(findings.front().statement, HasSubstr(GetParam().statement));
    EXPECT_EQ(findings.front().severity, GetParam().severity);
  }
}

INSTANTIATE_TEST_SUITE_P(Each, PlantedFault, ::testing::ValuesIn(kFaults),
                         [](const auto& each) { return std::string(each.param.name); });

TEST(NavigationChecks, TellADelayToTheTenth) {
  for (const double delay_s : {0.3, -0.4, 2.0, -7.5, 18.0}) {
    for (const double sigma_m : {0.01, 0.05}) {
      SimulatedSensors sensors;
      sensors.gnss_sigma_m = sigma_m;
      MadeRecording recording = made_drive(sensors);
      move_fixes(recording, delay_s);
      const auto findings = findings_in(recording);
      ASSERT_THAT(codes_of(findings), ElementsAre("gnss_late")) << delay_s << texts_of(findings);
      const std::string& statement = findings.front().statement;
      EXPECT_NEAR(std::stod(statement.substr(statement.find('=') + 1)), delay_s, 0.1)
          << texts_of(findings);
    }
  }
}

TEST(NavigationChecks, SayNothingOfADriveThatIsRight) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    for (const double sigma_m : {0.01, 0.3, 2.0}) {
      for (const double heading_deg : {0.0, 0.3, 3.0}) {
        SimulatedSensors sensors;
        sensors.seed = seed;
        sensors.gnss_sigma_m = sigma_m;
        sensors.heading_sigma_deg = heading_deg;
        sensors.gnss_hz = seed % 2 == 0 ? 1 : 10;
        sensors.gnss_latency_s = 0.1;
        const auto findings = findings_in(made_drive(sensors, 60 + 20 * seed));
        EXPECT_THAT(findings, IsEmpty()) << texts_of(findings);
      }
    }
  }
}

TEST(NavigationChecks, SayNothingOfAFewSeconds) {
  SimulatedSensors sensors;
  for (const double seconds : {0.05, 0.5, 3.0, 8.0, 12.0}) {
    const auto findings = findings_in(made_drive(sensors, seconds));
    EXPECT_THAT(findings, IsEmpty()) << seconds << "\n" << texts_of(findings);
  }
}

TEST(NavigationChecks, OneFixFarAwayIsNoContradiction) {
  for (const int bad : {40, 300, 700}) {
    MadeRecording recording = made_drive();
    int count = 0;
    recording.for_each<GnssFix>([&](GnssFix& f) {
      if (++count == bad) f.latitude_deg += 1e-3;  // 111 m
    });
    const auto findings = findings_in(recording);
    EXPECT_THAT(findings, IsEmpty()) << texts_of(findings);
  }
}

TEST(NavigationChecks, AVehicleThatReversesIsNoContradiction) {
  MadeRecording recording = made_drive();
  // The log of the same car driven backwards: its body looks the other way.
  recording.for_each<ImuSample>([](ImuSample& s) {
    for (auto* v : {&s.angular_rate, &s.specific_force}) v->head<2>() *= -1;
  });
  int count = 0;
  recording.for_each<WheelOdometry>([&](WheelOdometry& w) {
    // The last half of it only.
    if (++count > 450) w.ticks = {900000 - w.ticks->left, 900000 - w.ticks->right};
  });
  EXPECT_THAT(codes_of(findings_in(recording)), IsEmpty());
}

TEST(NavigationChecks, WhatIsAcceptedIsMarked) {
  MadeRecording recording = made_drive({}, 20);
  scale_force(recording, 1 / 9.80665);
  recording.info.accepted_contradictions = {"gnss_late", "imu_in_g"};
  const auto findings = findings_in(recording);
  ASSERT_THAT(codes_of(findings), ElementsAre("imu_in_g"));
  EXPECT_TRUE(findings.front().is_accepted);
}

TEST(NavigationChecks, EveryCodeIsListed) {
  std::ifstream file(std::string(TRAVERSE_SOURCE_DIR) + "/docs/contradictions.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::vector<std::string> listed;
  for (const auto& check : list_checks()) {
    listed.push_back(check.code);
    EXPECT_GT(check.holds.size(), 20U) << check.code;
    EXPECT_THAT(text, HasSubstr("| `" + check.code + "` | " + check.holds + " |"));
  }
  for (const Fault& fault : kFaults) {
    for (const std::string& code : fault.codes) EXPECT_THAT(listed, Contains(code));
  }
}

}  // namespace
}  // namespace traverse::plausibility
