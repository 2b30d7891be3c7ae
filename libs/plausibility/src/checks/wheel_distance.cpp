#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "checks/check.hpp"
#include "comparison/motion_sources.hpp"
#include "comparison/place_judgement.hpp"
#include "comparison/ratio.hpp"

namespace traverse::plausibility {

namespace {

// A tyre's rolling radius varies by a few percent with wear, load and pressure; what is stated of
// a wheel by hand is good to ten. Slip lasts for seconds, not for half of a drive.
constexpr double kMaxScale = 1.2;

constexpr std::array<CodeMeaning, 4> kWheelCodes{{
    {"wheels_cumulative",
     "Distances by pulses against those of lidar odometry or between fixes: "
     "nowhere near, while the differences of the counts are within a factor 2."},
    {"wheels_interval",
     "The same, while the counts themselves are: they were differenced although "
     "each stands for its interval."},
    {"wheels_scale", "The same distances, off by one factor of more than 1.2."},
    {"wheels_backwards",
     "Distances that are negative where lidar odometry goes forward, or, against "
     "fixes, for nineteen twentieths of the path."},
}};

struct Piece {
  double t0, t1;
  double metres;
};

/// Pieces of the path by another stream, and whether they tell forward from backward.
struct Pieces {
  std::string name;
  std::vector<Piece> pieces;
  bool are_signed = false;
};

std::optional<Pieces> reference_pieces(const View& view, const WheelTrack& wheels) {
  const Accumulated<3>& distance = wheels.distance();
  if (distance.empty()) return std::nullopt;
  if (const auto odometry = odometry_distance(view.evidence)) {
    constexpr double kPiece_s = 1;
    Pieces result{odometry->name, {}, true};
    for (double t = distance.begin_s(); t + kPiece_s <= distance.end_s(); t += kPiece_s) {
      const auto way = odometry->between(t, t + kPiece_s);
      // Odometry stands still to a few centimetres.
      if (way && std::abs(*way) > 0.2) result.pieces.push_back({t, t + kPiece_s, *way});
    }
    if (!result.pieces.empty()) return result;
  }
  for (const auto& [label, receiver] : view.receivers) {
    Pieces result{"the fixes", {}, false};
    for (const Leg& leg : receiver.legs.legs) {
      result.pieces.push_back({leg.t0, leg.t1, leg.length_m()});
    }
    if (!result.pieces.empty()) return result;
  }
  return std::nullopt;
}

std::optional<Ratio::Result> ratio_of(const WheelTrack& wheels, const Pieces& pieces,
                                      WheelTrack::Reading reading, bool with_sign) {
  constexpr std::size_t kMinPieces = 5;
  constexpr double kMinLength_m = 10;
  Ratio ratio;
  for (const Piece& piece : pieces.pieces) {
    const auto told = wheels.distance().between(piece.t0, piece.t1);
    if (!told) continue;
    ratio.add(piece.metres, with_sign ? (*told)[reading] : std::abs((*told)[reading]));
  }
  return ratio.find(kMinPieces, kMinLength_m);
}

bool fits(const std::optional<Ratio::Result>& ratio) {
  return ratio && ratio->is_consistent() && ratio->value > 0.5 && ratio->value < 2;
}

void look_at_wheels(const View& view, std::vector<Finding>& findings) {
  const Evidence& evidence = view.evidence;
  for (const auto& [label, track] : evidence.wheels) {
    const auto pieces = reference_pieces(view, track);
    if (!pieces) continue;
    const auto as_read = ratio_of(track, *pieces, WheelTrack::kAsRead, pieces->are_signed);
    if (!as_read) continue;
    const auto size = ratio_of(track, *pieces, WheelTrack::kAsRead, false);
    const auto figure = [&](const char* what, double value) {
      return fmt::format(
          "{} {:.3g} times those of {} (half of them within {:.0f} %, over {:.0f} m)", what, value,
          pieces->name, 100 * as_read->spread, as_read->sum);
    };
    const bool is_log = evidence.recording.format == "navigation log";
    if (track.has_pulses() && !fits(size)) {
      const auto differences = ratio_of(track, *pieces, WheelTrack::kSumsForCounts, false);
      const auto counts = ratio_of(track, *pieces, WheelTrack::kCountsForSums, false);
      if (fits(differences)) {
        findings.push_back(
            {"wheels_cumulative", Severity::kRefuse, label,
             figure("distances by its pulses are", as_read->value) +
                 fmt::format("; those by their differences {:.3g} times: the counts are cumulative",
                             differences->value),
             "The wheels would tell of hundreds of metres a second",
             is_log ? "--recording log.pulses=cumulative" : ""});
        continue;
      }
      if (fits(counts)) {
        findings.push_back({"wheels_interval", Severity::kRefuse, label,
                            figure("distances by differences of its counts are", as_read->value) +
                                fmt::format("; those by the counts {:.3g} times: each is of its "
                                            "interval",
                                            counts->value),
                            "The wheels would say that the vehicle stands",
                            is_log ? "--recording log.pulses=interval" : ""});
        continue;
      }
    }
    if (!as_read->is_consistent()) continue;
    const double k = as_read->value;
    bool is_backwards = k < 0;
    if (!pieces->are_signed) {
      double ahead = 0;
      double back = 0;
      for (const Piece& piece : pieces->pieces) {
        const auto told = track.distance().between(piece.t0, piece.t1);
        if (told) ((*told)[WheelTrack::kAsRead] > 0 ? ahead : back) += piece.metres;
      }
      is_backwards = back > 19 * ahead;
    }
    if (is_backwards) {
      findings.push_back({"wheels_backwards", Severity::kWarn, label,
                          figure("distances are", pieces->are_signed ? k : -k),
                          "Wheels that count backwards would turn the vehicle round",
                          "--recording vehicle.wheels.left_m_per_pulse=-X --recording "
                          "vehicle.wheels.right_m_per_pulse=-X"});
      continue;
    }
    if (k > 1 / kMaxScale && k < kMaxScale) continue;
    std::string statement;
    const auto* mounted = evidence.recording.rig.find(label);
    if (track.has_pulses() && mounted != nullptr && mounted->encoder) {
      statement = fmt::format(
          "--recording vehicle.wheels.left_m_per_pulse={:.6g} --recording "
          "vehicle.wheels.right_m_per_pulse={:.6g}",
          mounted->encoder->left_m_per_pulse / k, mounted->encoder->right_m_per_pulse / k);
    }
    findings.push_back({"wheels_scale", Severity::kWarn, label, figure("distances are", k),
                        "Wheels and the other sensors would pull the path in two directions",
                        std::move(statement)});
  }
}

}  // namespace

const Check kWheelDistance{kWheelCodes, look_at_wheels};

}  // namespace traverse::plausibility
