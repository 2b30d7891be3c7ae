#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "checks/check.hpp"
#include "comparison/delay.hpp"

namespace traverse::plausibility {

namespace {

// A scan's pose is that of its stamp. A stamp of another moment of the sweep, which lasts 0.05 to
// 0.2 s, shows as a delay against a gyro by up to one sweep; a longer one is of another clock.
constexpr std::array<CodeMeaning, 1> kLidarTimeCodes{
    {{"lidar_late",
      "Turns by lidar odometry against those of a gyro, shifted in time by up to 10 s: "
      "more than 0.03 s away they agree better by three tenths and four sigma."}}};

void look_at_lidar_time(const View& view, std::vector<Finding>& findings) {
  const Evidence& evidence = view.evidence;
  constexpr double kPiece_s = 1;
  constexpr double kMinDelay_s = 0.03;
  constexpr double kReach_s = 10;
  const Accumulated<3>& turn = evidence.odometry.turn;
  if (turn.empty()) return;
  std::vector<TimedPiece> pieces;
  for (double t = turn.begin_s(); t + kPiece_s <= turn.end_s(); t += kPiece_s) {
    const auto angle = turn.between(t, t + kPiece_s);
    if (angle) pieces.push_back({t, t + kPiece_s, angle->z()});
  }
  const auto* lidar = evidence.recording.rig.first(sensors::SensorKind::kLidar);
  for (const auto& [label, track] : evidence.imus) {
    if (track.turn().empty()) continue;
    const MotionSource gyro = gyro_turn(evidence, label);
    const auto delay = find_delay(pieces, gyro, kReach_s);
    if (!delay || !delay->is_marked(kMinDelay_s)) continue;
    findings.push_back(
        {"lidar_late", Severity::kWarn, lidar != nullptr ? lidar->label : "",
         fmt::format(
             "its turns go best with {} as those of {:.3f} s {} the scans' stamps: the mean "
             "difference is then {:.1f} %, else {:.1f} %, over {} pieces",
             label, std::abs(delay->seconds), delay->seconds > 0 ? "before" : "after",
             100 * delay->there.mean, 100 * delay->at_zero.mean, delay->there.pieces),
         std::abs(delay->seconds) < 0.25 ? "Scans are stamped at another moment of the sweep than "
                                           "is taken for true; what other "
                                           "sensors say is held against the wrong moment"
                                         : "The lidar's clock is another one than the IMU's",
         std::abs(delay->seconds) < 0.25
             ? "--recording lidar.stamp_fraction=0 (first point), 0.5 or 1 (last)"
             : ""});
  }
}

}  // namespace

const Check kLidarTime{kLidarTimeCodes, look_at_lidar_time};

}  // namespace traverse::plausibility
