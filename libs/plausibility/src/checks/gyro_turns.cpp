#include <array>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "checks/check.hpp"
#include "comparison/legs.hpp"
#include "comparison/motion_sources.hpp"
#include "comparison/place_judgement.hpp"
#include "comparison/ratio.hpp"

namespace traverse::plausibility {

namespace {

constexpr double kDegreesPerRadian = 57.29578;

// A turn is the same for all that turn together. Units differ by 57.3, increments by the rate of
// the readings: a factor is judged by which of these is nearer, in logarithms.
constexpr std::array<CodeMeaning, 4> kTurnCodes{{
    {"gyro_deg",
     "Turns about the body's z axis by the gyro, against those of lidar odometry, of "
     "wheels, or of the course between fixes: 57.3 times as large, within a factor 1.5."},
    {"gyro_small",
     "The same, less than a seventh: rad/s that are taken for degrees, or increments "
     "of angle."},
    {"gyro_mirrored",
     "The same with the other sign, where it is not the places that are mirrored."},
    {"gyro_scale", "The same, off by more than a factor 1.5 that is none of these."},
}};

struct TurnRatio {
  Ratio::Result ratio;
  std::string against;
};

/// Against lidar odometry or wheels by pieces of a second; else against the course.
std::optional<TurnRatio> turn_ratio(const View& view, const std::string& imu) {
  const Evidence& evidence = view.evidence;
  constexpr std::size_t kMinPairs = 4;
  constexpr double kMinTurn = 1;  // rad in all: less is not told from a bias
  const MotionSource gyro = gyro_turn(evidence, imu);
  for (const MotionSource& other : other_turns(evidence)) {
    Ratio ratio;
    const Accumulated<3>& turn = evidence.imus.at(imu).turn();
    if (turn.empty()) return std::nullopt;
    constexpr double kPiece_s = 1;
    for (double t = turn.begin_s(); t + kPiece_s <= turn.end_s(); t += kPiece_s) {
      const auto expected = other.between(t, t + kPiece_s);
      const auto found = gyro.between(t, t + kPiece_s);
      // Half a degree a second is more than the bias of a cheap gyro; ten times that is a turn.
      if (expected && found && std::abs(*expected) > 0.1) ratio.add(*expected, *found);
    }
    const auto found = ratio.find(kMinPairs, kMinTurn);
    if (found && found->is_consistent()) return TurnRatio{*found, other.name};
  }
  for (const auto& [label, receiver] : view.receivers) {
    Ratio ratio;
    for (const CourseTurn& turn : course_turns(receiver.legs)) {
      const auto found = gyro.between(turn.t0, turn.t1);
      if (found) ratio.add(turn.turn, *found);
    }
    const auto found = ratio.find(kMinPairs, kMinTurn);
    if (found && found->is_consistent()) return TurnRatio{*found, "the course between fixes"};
  }
  return std::nullopt;
}

std::string gyro_unit_statement(const dataset::RecordingInfo& recording, const char* unit) {
  const char* group = recording.format == "navigation log" ? "log"
                      : recording.format == "CSV folder"   ? "csv"
                                                           : "imu";
  return fmt::format("--recording {}.angular_rate={}", group, unit);
}

void look_at_gyro(const View& view, std::vector<Finding>& findings) {
  const Evidence& evidence = view.evidence;
  for (const auto& [label, track] : evidence.imus) {
    const auto turns = turn_ratio(view, label);
    if (!turns || turns->ratio.is_near(1)) continue;
    const double k = turns->ratio.value;
    Finding finding{"gyro_scale", Severity::kRefuse, label, {}, {}, {}};
    finding.figure =
        fmt::format("its turns are {:.3g} times those of {} ({:.0f} deg in {} turns)", k,
                    turns->against, turns->ratio.sum * kDegreesPerRadian, turns->ratio.pairs);
    finding.consequence = "Heading and, through it, the path would be wrong from the first turn on";
    if (std::abs(turns->ratio.value / kDegreesPerRadian) > 1 / 1.5 &&
        std::abs(turns->ratio.value / kDegreesPerRadian) < 1.5) {
      finding.code = "gyro_deg";
      finding.figure += "; degrees a second taken for radians give 57.3";
      finding.statement = gyro_unit_statement(evidence.recording, "deg");
    } else if (turns->ratio.is_near(-1)) {
      finding.code = "gyro_mirrored";
      finding.consequence += "; its z axis points down, or the receiver's places are mirrored";
      finding.statement = "--recording \"vehicle.imu.roll_pitch_yaw_deg=[180, 0, 0]\"";
    } else if (std::abs(k) < 1.0 / 7) {
      finding.code = "gyro_small";
      const auto interval = track.interval_s();
      const bool are_increments =
          interval && std::abs(std::log(std::abs(k) / *interval)) <
                          std::abs(std::log(std::abs(k) * kDegreesPerRadian));
      finding.figure += are_increments
                            ? fmt::format("; increments of angle give {:.3g}", *interval)
                            : std::string("; radians a second taken for degrees give 0.0175");
      finding.statement = are_increments ? "--recording imu.angular_rate=increment"
                                         : gyro_unit_statement(evidence.recording, "rad");
    }
    findings.push_back(std::move(finding));
  }
}

}  // namespace

const Check kGyroTurns{kTurnCodes, look_at_gyro};

}  // namespace traverse::plausibility
