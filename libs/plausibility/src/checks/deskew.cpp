#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "traverse/statistics/quantile.hpp"

#include "checks/check.hpp"

namespace traverse::plausibility {

namespace {

constexpr std::array<CodeMeaning, 4> kDeskewCodes{{
    {"scans_not_compensated",
     "The share of the motion within a sweep that is in the points of scans a few metres apart "
     "(1: raw, 0: compensated), found with their rigid motion by least squares on planes, in the "
     "median of at least three pairs: nearer to 1, of scans that are taken for compensated."},
    {"scans_compensated", "The same, nearer to 0, of scans that are taken for raw."},
    {"point_times_reversed",
     "The same, nearer to -1: the lidar turns the other way, or times count "
     "back."},
    {"point_times_unknown",
     "The same, nearer to 1, of raw scans whose point times nothing tells, by "
     "times that follow from the azimuth."},
}};

struct Share {
  double value = 0;
  double sigma = 0;  // of the median, from the spread of the pairs and what they say of themselves
  std::size_t pairs = 0;
};

std::optional<Share> share_of(const DistortionTrack& track, std::optional<double> seam_deg) {
  constexpr std::size_t kMinPairs = 3;
  constexpr double kMaxSigma = 0.6;  // else a pair tells nothing
  std::vector<double> shares;
  std::vector<double> sigmas;
  for (const DistortionTrack::Pair& pair : track.pairs()) {
    if (pair.seam_deg != seam_deg || pair.distortion.sigma > kMaxSigma) continue;
    shares.push_back(pair.distortion.share);
    sigmas.push_back(pair.distortion.sigma);
  }
  if (shares.size() < kMinPairs) return std::nullopt;
  Share share;
  share.pairs = shares.size();
  share.value = statistics::median(shares);
  std::vector<double> deviations;
  for (const double s : shares) deviations.push_back(std::abs(s - share.value));
  const double spread = 1.4826 * statistics::median(deviations);
  share.sigma = 1.2533 * std::max(spread, statistics::median(sigmas)) /
                std::sqrt(static_cast<double>(shares.size()));
  return share;
}

// The nearest of 1, 0 and -1, by three sigma.
bool is_raw(const Share& share) { return share.value - 3 * share.sigma > 0.5; }
bool is_compensated(const Share& share) { return std::abs(share.value) + 3 * share.sigma < 0.5; }
bool is_reversed(const Share& share) { return share.value + 3 * share.sigma < -0.5; }

void look_at_deskew(const View& view, std::vector<Finding>& findings) {
  const Evidence& evidence = view.evidence;
  const auto* lidar = evidence.recording.rig.first(sensors::SensorKind::kLidar);
  if (lidar == nullptr) return;
  const auto figure = [](const Share& share) {
    return fmt::format(
        "{:.2f} +- {:.2f} of the motion within a sweep is in the points (median of {} "
        "pairs of scans)",
        share.value, share.sigma, share.pairs);
  };
  if (const auto share = share_of(evidence.distortion, std::nullopt)) {
    const bool are_stated = evidence.recording.motion_compensated;
    if (are_stated && is_raw(*share)) {
      findings.push_back({"scans_not_compensated", Severity::kWarn, lidar->label,
                          figure(*share) + "; 0 expected of compensated scans",
                          "The scans are raw: without deskew, maps blur and drift grows with speed",
                          "--recording motion_compensated=false"});
    } else if (!are_stated && is_compensated(*share)) {
      findings.push_back({"scans_compensated", Severity::kWarn, lidar->label,
                          figure(*share) + "; 1 expected of raw scans",
                          "The scans were deskewed before: doing it again distorts them",
                          "--recording motion_compensated=true"});
    } else if (!are_stated && is_reversed(*share)) {
      findings.push_back({"point_times_reversed", Severity::kWarn, lidar->label,
                          figure(*share) + "; 1 expected of raw scans",
                          "Deskew doubles the distortion instead of taking it off",
                          lidar->lidar && lidar->lidar->time_source == sensors::TimeSource::kAzimuth
                              ? fmt::format("--recording lidar.rotation={}",
                                            lidar->lidar->rotation == sensors::Rotation::kClockwise
                                                ? "counterclockwise"
                                                : "clockwise")
                              : "--recording lidar.time_source=azimuth (with lidar.rotation and "
                                "lidar.seam_azimuth_deg)"});
    }
    return;
  }
  if (evidence.recording.motion_compensated) return;
  std::optional<Share> best;
  double best_seam_deg = 0;
  for (const double seam_deg : DistortionTrack::kSeams_deg) {
    const auto share = share_of(evidence.distortion, seam_deg);
    // At a wrong seam the times say nothing, and the share is small.
    if (!share || !(is_raw(*share) || is_reversed(*share))) continue;
    const auto certainty = [](const Share& s) { return std::abs(s.value) - 3 * s.sigma; };
    if (best && certainty(*share) < certainty(*best)) continue;
    best = share;
    best_seam_deg = seam_deg;
  }
  if (!best) return;
  const char* rotation = is_raw(*best) ? "clockwise" : "counterclockwise";
  best->value = std::abs(best->value);
  findings.push_back(
      {"point_times_unknown", Severity::kWarn, lidar->label,
       fmt::format("{}, if the lidar turns {} from {:.0f} deg on; nothing tells when a point was "
                   "measured",
                   figure(*best), rotation, best_seam_deg),
       "The scans are raw, and are not deskewed: maps blur and drift grows with speed",
       fmt::format(
           "--recording lidar.time_source=azimuth --recording lidar.rotation={} --recording "
           "lidar.seam_azimuth_deg={:.0f} --recording lidar.sweep_s={:.3g}",
           rotation, best_seam_deg, evidence.distortion.sweep_s())});
}

}  // namespace

const Check kDeskew{kDeskewCodes, look_at_deskew};

}  // namespace traverse::plausibility
