#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "checks/check.hpp"

namespace traverse::plausibility {

namespace {

constexpr std::array<CodeMeaning, 1> kUprightCodes{
    {{"imu_not_upright",
      "The mean direction of the specific force in the body's axes, of a vehicle that has wheels "
      "or a "
      "receiver. It points up, along z: roads are steep to 20 degrees, so that 45 are the "
      "mounting."}}};

void look_at_uprightness(const View& view, std::vector<Finding>& findings) {
  const Evidence& evidence = view.evidence;
  constexpr double kMinSeconds = 1;
  constexpr double kMaxTilt_deg = 45;
  const bool is_ground_vehicle = evidence.recording.rig.first(sensors::SensorKind::kWheels) ||
                                 evidence.recording.rig.first(sensors::SensorKind::kGnss);
  if (!is_ground_vehicle) return;
  for (const auto& [label, track] : evidence.imus) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double size = 0;
    double seconds = 0;
    track.push().for_each_piece([&](double t0, double t1, const Eigen::Vector3d& push) {
      sum += push;
      size += push.norm();
      seconds += t1 - t0;
    });
    // Without a direction in common (gravity taken out, an IMU in a hand) there is nothing to tell.
    if (seconds < kMinSeconds || !(sum.norm() > 0.8 * size)) continue;
    const Eigen::Vector3d up_body = evidence.R_body(label) * sum.normalized();
    const double tilt_deg = std::acos(std::clamp(up_body.z(), -1.0, 1.0)) * 180 / std::numbers::pi;
    if (tilt_deg < kMaxTilt_deg) continue;
    const bool is_upside_down = tilt_deg > 180 - kMaxTilt_deg;
    findings.push_back(
        {"imu_not_upright", Severity::kWarn, label,
         fmt::format(
             "in the body's axes the mean specific force points to ({:.2f}, {:.2f}, {:.2f}), "
             "{:.0f} deg off up, which is (0, 0, 1)",
             up_body.x(), up_body.y(), up_body.z(), tilt_deg),
         "Turns and accelerations would be taken about and along wrong axes",
         is_upside_down
             ? "--recording \"vehicle.imu.roll_pitch_yaw_deg=[180, 0, 0]\" (or a pitch of "
               "180, as it is mounted)"
             : "--recording \"vehicle.imu.roll_pitch_yaw_deg=[ROLL, PITCH, YAW]\""});
  }
}

}  // namespace

const Check kImuUpright{kUprightCodes, look_at_uprightness};

}  // namespace traverse::plausibility
