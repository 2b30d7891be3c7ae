#include "traverse/pipeline/run_health.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/pipeline/rejections_text.hpp"
#include "traverse/statistics/quantile.hpp"

#include "frame_evidence.hpp"

namespace traverse::pipeline {

namespace {

// The limits below are none of a drive's; docs/run-folder.md repeats them with their reasons.

/// Less than half: more of the path is guessed than measured.
constexpr double kHalf = 0.5;
/// More than a tenth of anything is missing.
constexpr double kTenth = 0.1;
/// A vehicle may change its speed by 2 m/s every second without anybody noticing. So long after the
/// last registration the prediction of constant velocity is 1 m off, about the reach of the next.
constexpr double kLongestPrediction_s = 1;
/// An acceleration that is off by 0.02 m/s^2 (a consumer IMU, 0.1 degree of tilt) is 1 m after it.
constexpr double kLongestDeadReckoning_s = 10;
/// A gate that leaves out one in a thousand leaves out a tenth only of readings that are wrong, or
/// by an estimate that is; and so long only if it cannot tell which.
constexpr double kLongRejection_s = kLongestDeadReckoning_s;
/// Of 10 m and more a path has a shape that can be told from its noise.
constexpr double kLeastPath_m = 10;
/// An estimate that misses by half of what standing still would miss tells no path. One that misses
/// by a tenth is worse than the speedometer of a car may be (UN Regulation No. 39).
constexpr double kLostError = 0.5;
constexpr double kDegradedError = 0.1;
constexpr double kLongGap_s = 1;
constexpr double kGap = 1.5;  // usual intervals
/// Half a minute of a start is a start; of longer ones a tenth of the recording counts.
constexpr double kLongStart_s = 30;
/// What registration is off by, and five times the acceleration of gravity: a crash.
constexpr double kLeap_m = 1;
constexpr double kLargestAcceleration_mps2 = 50;
/// For a second on end: poses that are each off by a decimetre (a step and the one before it by the
/// root of six of that), and an acceleration as that of gravity, which tyres do not hold.
constexpr double kShaking_m = 0.245;
constexpr double kShaking_mps2 = 9.81;
constexpr double kShakingFor_s = 1;
constexpr std::size_t kFewestFrames = 5;  // to tell a rule from a coincidence

std::string percent(double share) {
  const double value = 100 * share;
  return value != 0 && value < 9.95 ? fmt::format("{:.2g} %", value)
                                    : fmt::format("{:.0f} %", value);
}

std::string seconds_text(double seconds) {
  return seconds < 9.95 ? fmt::format("{:.2g} s", seconds) : fmt::format("{:.0f} s", seconds);
}

std::string metres_text(double metres) {
  return metres < 99.5 ? fmt::format("{:.3g} m", metres) : fmt::format("{:.0f} m", metres);
}

std::string counted(std::size_t count, const char* noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

double seconds_between(const geometry::Trajectory& path, std::size_t from, std::size_t to) {
  return geometry::seconds_between(path.stamp(from), path.stamp(to));
}

/// The spells of frames that are marked.
Spells spells_of(const std::vector<bool>& marked, const HealthEvidence& evidence) {
  const geometry::Trajectory& path = evidence.T_map_body;
  const std::vector<double> numbers = evidence.frames.column("frame");
  Spells spells;
  for (std::size_t i = 0; i < marked.size();) {
    if (!marked[i]) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < marked.size() && marked[end]) ++end;
    const std::size_t before = i > 0 ? i - 1 : i;
    const std::size_t after = std::min(end, marked.size() - 1);
    const Spell spell{end - i, static_cast<std::size_t>(numbers[i]), seconds_between(path, 0, i),
                      seconds_between(path, before, after)};
    spells.frames += spell.frames;
    ++spells.count;
    if (spells.count == 1 || spell.seconds > spells.longest.seconds) spells.longest = spell;
    i = end;
  }
  return spells;
}

/// Degenerate frames that lie longer than a prediction holds after the last that was determined. Of
/// those at the beginning all, unless they are soon over: no motion was known that could have gone
/// on.
std::size_t unsupported(const FrameEvidence& frames, const geometry::Trajectory& path) {
  std::size_t count = 0;
  std::size_t at_beginning = 0;
  std::optional<std::size_t> determined;
  for (std::size_t i = 1; i < path.size(); ++i) {
    if (frames.is_lost[i]) continue;
    if (!frames.is_degenerate[i]) {
      if (!determined && seconds_between(path, 0, i) <= kLongestPrediction_s) at_beginning = 0;
      determined = i;
    } else if (!determined) {
      ++at_beginning;
    } else if (seconds_between(path, *determined, i) > kLongestPrediction_s) {
      ++count;
    }
  }
  return at_beginning + count;
}

Gaps gaps_of(const HealthEvidence& evidence) {
  const geometry::Trajectory& path = evidence.T_map_body;
  std::vector<double> intervals;
  for (std::size_t i = 1; i < path.size(); ++i)
    intervals.push_back(seconds_between(path, i - 1, i));
  Gaps gaps;
  if (intervals.empty()) return gaps;
  gaps.usual_s = statistics::median(intervals);
  for (const double interval : intervals) gaps.count += interval > kGap * gaps.usual_s ? 1 : 0;
  const auto longest = std::max_element(intervals.begin(), intervals.end());
  gaps.longest_s = *longest;
  gaps.after_frame = static_cast<std::size_t>(
      evidence.frames.column("frame")[static_cast<std::size_t>(longest - intervals.begin())]);
  return gaps;
}

/// A step beyond where the velocity before it led.
struct StepOff {
  std::size_t to = 0;  ///< pose
  double off_m = 0;
  double dt = 0, before = 0;  ///< seconds of the step, and of the motion that it is held against
};

/// The second in which the steps of the path fit each other worst.
struct Shaking {
  double of_limit = 0;    ///< root mean square of what a step is off, by the limit of one
  double rms_m = 0;       ///< beyond where the motion before led
  std::size_t frame = 0;  ///< the first of them
};

/// How steps go on from the velocity before them: the mean of at least as long a time as the step
/// takes, since frames may follow each other closely. \param corrected frames in which the
/// estimator learned where it is, after a time in which it did not know \param leaps those after
/// which motion is told anew
std::vector<StepOff> steps_off(const geometry::Trajectory& path, const std::vector<bool>& corrected,
                               bool (*leaps)(const StepOff&)) {
  std::vector<StepOff> steps;
  std::size_t begin = 0;  // of the motion that a step is held against
  for (std::size_t i = 1; i < path.size(); ++i) {
    if (corrected[i]) begin = i;
    const double dt = seconds_between(path, i - 1, i);
    std::size_t from = i - 1;
    while (from > begin && seconds_between(path, from, i - 1) < dt) --from;
    const double before = seconds_between(path, from, i - 1);
    if (i - 1 <= begin || !(dt > 0) || before < 0.99 * dt) continue;
    const Eigen::Vector3d& p_last = path.pose(i - 1).translation;
    const Eigen::Vector3d velocity = (p_last - path.pose(from).translation) / before;
    const double off_m = (path.pose(i).translation - p_last - dt * velocity).norm();
    steps.push_back({i, off_m, dt, before});
    if (leaps(steps.back())) begin = i;
  }
  return steps;
}

bool is_leap(const StepOff& step) {
  return step.off_m > kLeap_m + 0.5 * kLargestAcceleration_mps2 * step.dt * (step.dt + step.before);
}

Leaps leaps_of(const HealthEvidence& evidence, const std::vector<bool>& corrected) {
  const std::vector<double> numbers = evidence.frames.column("frame");
  Leaps leaps;
  for (const StepOff& step : steps_off(evidence.T_map_body, corrected, is_leap)) {
    if (!is_leap(step)) continue;
    ++leaps.count;
    if (step.off_m <= leaps.largest_m) continue;
    leaps.largest_m = step.off_m;
    leaps.seconds = step.dt;
    leaps.frame = static_cast<std::size_t>(numbers[step.to]);
  }
  return leaps;
}

Shaking shaking_of(const HealthEvidence& evidence, const std::vector<bool>& corrected) {
  const geometry::Trajectory& path = evidence.T_map_body;
  const std::vector<double> numbers = evidence.frames.column("frame");
  const std::vector<StepOff> steps =
      steps_off(path, corrected, [](const StepOff&) { return false; });
  Shaking shaking;
  for (std::size_t first = 0, end = 0; first < steps.size(); ++first) {
    end = std::max(end, first);
    const auto last_s = [&] { return seconds_between(path, steps[first].to, steps[end - 1].to); };
    while (end < steps.size() && (end <= first || last_s() < kShakingFor_s)) ++end;
    // The last second of a path is whole when its last step is a step short of it.
    if (last_s() + 1.01 * steps[end - 1].dt < kShakingFor_s || end - first < 2 * kFewestFrames) {
      break;
    }
    double squares = 0;
    double squares_m2 = 0;
    for (std::size_t i = first; i < end; ++i) {
      const StepOff& step = steps[i];
      const double limit_m = kShaking_m + 0.5 * kShaking_mps2 * step.dt * (step.dt + step.before);
      squares += step.off_m * step.off_m / (limit_m * limit_m);
      squares_m2 += step.off_m * step.off_m;
    }
    const auto count = static_cast<double>(end - first);
    const double of_limit = std::sqrt(squares / count);
    if (of_limit <= shaking.of_limit) continue;
    shaking = {of_limit, std::sqrt(squares_m2 / count),
               static_cast<std::size_t>(numbers[steps[first].to])};
  }
  return shaking;
}

/// Root mean square of the reference's distances from its centre, of the matched poses.
double spread_of(const geometry::Trajectory& reference, const evaluation::Comparison& comparison) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0;
  const auto for_each = [&](const auto& use) {
    for (const auto& match : comparison.association.matches) {
      if (match.reference < reference.size()) use(reference.pose(match.reference).translation);
    }
  };
  for_each([&](const Eigen::Vector3d& p) {
    sum += p;
    ++count;
  });
  double squares = 0;
  for_each([&](const Eigen::Vector3d& p) { squares += (p - sum / count).squaredNorm(); });
  return count > 0 ? std::sqrt(squares / count) : 0;
}

/// Collects the reasons.
class Reasons {
 public:
  void add(Health severity, std::string code, std::string text) {
    list_.push_back({severity, std::move(code), std::move(text)});
  }
  /// The most severe first, else in the order in which they were found.
  std::vector<HealthReason> take() {
    std::stable_sort(list_.begin(), list_.end(), [](const auto& a, const auto& b) {
      return static_cast<int>(a.severity) > static_cast<int>(b.severity);
    });
    return std::move(list_);
  }

 private:
  std::vector<HealthReason> list_;
};

void judge_registration(const RunHealth& health, const FrameEvidence& frames, Reasons& reasons) {
  if (health.frames == 1) {
    reasons.add(Health::kDegraded, "one_frame", "One frame was estimated: there is no motion.");
  }
  const auto share = health.registered_share();
  const double limit_s = frames.is_navigation ? kLongestDeadReckoning_s : kLongestPrediction_s;
  const char* held =
      frames.is_navigation ? "rest on an accepted fix or wheel reading" : "were registered";
  const char* else_is = frames.is_navigation ? "dead reckoning by the IMU alone" : "a prediction";
  if (share && *share < kHalf) {
    reasons.add(Health::kLost, "not_registered",
                fmt::format("{} of {} {} ({}): the path is {}, not an estimate.", health.registered,
                            counted(health.registrable, "frame"), held, percent(*share), else_is));
  } else if (health.lost.frames > 0) {
    const Spell& longest = health.lost.longest;
    const bool ends_lost =
        frames.is_lost.back() && longest.first_frame + longest.frames == frames.numbers.back() + 1;
    const bool is_long = longest.seconds > limit_s;
    const bool is_tenth =
        static_cast<double>(longest.frames) > kTenth * static_cast<double>(health.registrable);
    if (ends_lost && is_long && is_tenth) {
      reasons.add(
          Health::kLost, "ends_lost",
          fmt::format("From frame {} on nothing was registered until the end ({}, {}): that "
                      "part of the path is {}.",
                      longest.first_frame, counted(longest.frames, "frame"),
                      seconds_text(longest.seconds), else_is));
    } else if (is_long || !frames.is_navigation) {
      reasons.add(
          Health::kDegraded, "not_registered",
          fmt::format("{} of {} {} ({}); the longest stretch without is {} from frame {} on.",
                      health.registered, counted(health.registrable, "frame"), held,
                      percent(*share), seconds_text(longest.seconds), longest.first_frame));
    }
  }
  if (const auto located = health.located_share(); located && *located < 1) {
    reasons.add(*located < kHalf ? Health::kLost : Health::kDegraded, "not_located",
                fmt::format("The place in the map is known in {} of {} ({}).", *health.located,
                            counted(health.frames, "frame"), percent(*located)));
  }
}

void judge_motion(const RunHealth& health, const FrameEvidence& frames, const Shaking& shaking,
                  Reasons& reasons) {
  const auto of = static_cast<double>(health.registered);
  if (static_cast<double>(health.unsupported) > kHalf * of) {
    reasons.add(
        Health::kLost, "degenerate",
        fmt::format("{} of {} ({}) follow no measurement of a direction of motion, for longer "
                    "than a prediction holds: along it the path is none.",
                    health.unsupported, counted(health.registered, "registered frame"),
                    percent(static_cast<double>(health.unsupported) / of)));
  } else if (health.unsupported > 0) {
    reasons.add(
        Health::kDegraded, "degenerate",
        fmt::format("A direction of motion is not determined in {}, for up to {} from frame "
                    "{} on: along it the path is a prediction.",
                    counted(health.degenerate.frames, "frame"),
                    seconds_text(health.degenerate.longest.seconds),
                    health.degenerate.longest.first_frame));
  }
  if (frames.frozen > health.registered / 2 && frames.frozen >= kFewestFrames) {
    reasons.add(Health::kDegraded, "frozen",
                fmt::format("{} of {} have the pose before them to the last bit, although they say "
                            "that they were registered: noise alone moves a scan.",
                            frames.frozen, counted(health.registered, "frame")));
  }
  if (health.leaps.count > 0) {
    reasons.add(
        frames.knows_place ? Health::kDegraded : Health::kLost, "leap",
        fmt::format(
            "The path leaps by {} within {} at frame {}{}: no vehicle moves like "
            "that.",
            metres_text(health.leaps.largest_m), seconds_text(health.leaps.seconds),
            health.leaps.frame,
            health.leaps.count > 1 ? fmt::format(", one of {} leaps", health.leaps.count) : ""));
  }
  if (shaking.of_limit > 1 && !health.is_navigation) {
    reasons.add(Health::kDegraded, "shaking",
                fmt::format("For a second from frame {} on each step of the path is {} (rms) off "
                            "where the one before it led: poses or stamps are wrong.",
                            shaking.frame, metres_text(shaking.rms_m)));
  }
  if (health.restarts > 0) {
    reasons.add(Health::kDegraded, "restarted",
                fmt::format("The estimator gave up what it knew and began again {}.",
                            health.restarts == 1 ? "once" : counted(health.restarts, "time")));
  }
}

void judge_sensor(const SensorUse& sensor, bool is_navigation, Reasons& reasons) {
  const bool is_lidar = sensor.kind == sensors::SensorKind::kLidar;
  if (!sensor.is_taken || is_lidar) return;  // frames tell of scans
  const std::string_view kind = sensors::name_of(sensor.kind);
  const std::string of =
      sensor.label == kind ? sensor.label : fmt::format("{} ({})", sensor.label, kind);
  const std::size_t looked_at = sensor.used + sensor.rejected;
  if (sensor.read > 0 && looked_at == 0) {
    reasons.add(Health::kDegraded, "sensor_unused",
                fmt::format("None of the {} of {} was used{}.", counted(sensor.read, "reading"), of,
                            sensor.reason.empty() ? "" : ": " + sensor.reason));
    return;
  }
  const double share = sensor.rejected_share();
  const bool is_place = is_navigation && sensor.kind == sensors::SensorKind::kGnss;
  if (share <= kTenth && sensor.longest_rejected_s <= kLongRejection_s) return;
  reasons.add(
      is_place && share > kHalf ? Health::kLost : Health::kDegraded, "sensor_rejected",
      fmt::format("{} of {} of {} were rejected ({}), {}.", sensor.rejected,
                  counted(looked_at, "reading"), of, percent(share), rejections_text(sensor)));
}

void judge_recording(const RunHealth& health, Reasons& reasons) {
  const bool is_late = health.first_pose_share && *health.first_pose_share > kTenth &&
                       *health.first_pose_after_s > kLongStart_s;
  if (is_late) {
    reasons.add(
        Health::kDegraded, "late_start",
        fmt::format("The first pose comes {} after the recording begins, {} of it.",
                    seconds_text(*health.first_pose_after_s), percent(*health.first_pose_share)));
  }
  if (health.covered_share && *health.covered_share < kHalf) {
    reasons.add(
        *health.covered_share < kTenth ? Health::kLost : Health::kDegraded, "covered",
        fmt::format("The poses cover {} of the recording's time.", percent(*health.covered_share)));
  }
  if (health.gaps.longest_s > std::max(kLongGap_s, 3 * health.gaps.usual_s)) {
    reasons.add(Health::kDegraded, "gap",
                fmt::format("There is no frame for {} after frame {}; usual are {}.",
                            seconds_text(health.gaps.longest_s), health.gaps.after_frame,
                            seconds_text(health.gaps.usual_s)));
  }
  if (health.skipped_share > kTenth) {
    reasons.add(
        health.skipped_share > kHalf ? Health::kLost : Health::kDegraded, "skipped",
        fmt::format("{} could not be used ({} of all).", counted(health.skipped_records, "record"),
                    percent(health.skipped_share)));
  }
}

void judge_error(const HealthEvidence& evidence, RunHealth& health, Reasons& reasons) {
  if (evidence.evaluation == nullptr || evidence.reference == nullptr) return;
  const auto& comparison = evidence.evaluation->comparison;
  if (!comparison) return;
  const auto* ape = evaluation::find_ape(*comparison, evaluation::Relation::kTranslation);
  if (ape == nullptr) return;
  const double rmse = ape->statistics.rmse;
  if (comparison->path.reference_m < kLeastPath_m) {
    if (rmse <= kLeastPath_m) return;
    reasons.add(Health::kLost, "contradicts_reference",
                fmt::format("The reference moves by {} in all, the estimate is {} off it (APE).",
                            metres_text(comparison->path.reference_m), metres_text(rmse)));
    return;
  }
  const double spread = spread_of(*evidence.reference, *comparison);
  if (!(spread > 0)) return;
  health.error_share = rmse / spread;
  if (*health.error_share <= kDegradedError) return;
  reasons.add(*health.error_share > kLostError ? Health::kLost : Health::kDegraded,
              "contradicts_reference",
              fmt::format("The estimate and its reference differ by {} of the drive: APE {} where "
                          "the reference spreads over {} (root mean square); paths of {} and {}.",
                          percent(*health.error_share), metres_text(rmse), metres_text(spread),
                          metres_text(comparison->path.estimate_m),
                          metres_text(comparison->path.reference_m)));
}

void add_times(const HealthEvidence& evidence, RunHealth& health) {
  const geometry::Trajectory& path = evidence.T_map_body;
  if (!evidence.recording_first || !evidence.recording_last || path.empty()) return;
  const double all_s =
      geometry::seconds_between(*evidence.recording_first, *evidence.recording_last);
  if (!(all_s > 0)) return;
  health.first_pose_after_s = geometry::seconds_between(*evidence.recording_first, path.stamp(0));
  health.first_pose_share = *health.first_pose_after_s / all_s;
  health.covered_share = seconds_between(path, 0, path.size() - 1) / all_s;
}

/// What the data themselves show says more than what is known of their format.
bool has_found(const HealthEvidence& evidence, std::string_view code) {
  return std::any_of(evidence.contradictions.begin(), evidence.contradictions.end(),
                     [&](const Contradiction& found) { return found.code == code; });
}

}  // namespace

std::string_view name_of(Health health) {
  switch (health) {
    case Health::kOk:
      return "ok";
    case Health::kDegraded:
      return "degraded";
    case Health::kLost:
      return "lost";
  }
  return "lost";
}

std::optional<double> RunHealth::registered_share() const {
  if (registrable == 0) return std::nullopt;
  return static_cast<double>(registered) / static_cast<double>(registrable);
}

std::optional<double> RunHealth::located_share() const {
  if (!located || frames == 0) return std::nullopt;
  return static_cast<double>(*located) / static_cast<double>(frames);
}

std::string RunHealth::summary() const {
  std::string text;
  for (const HealthReason& reason : reasons) {
    if (reason.severity != verdict) continue;
    text += (text.empty() ? "" : " ") + reason.text;
  }
  return text;
}

RunHealth assess(const HealthEvidence& evidence) {
  RunHealth health;
  const FrameEvidence frames = read_frame_evidence(evidence.frames, evidence.T_map_body);
  health.is_navigation = frames.is_navigation;
  health.is_foreign = evidence.is_foreign;
  health.frames = evidence.T_map_body.size();
  health.registrable = frames.registrable;
  health.registered = frames.registered;
  health.located = frames.located;
  health.lost = spells_of(frames.is_lost, evidence);
  health.degenerate = spells_of(frames.is_degenerate, evidence);
  health.unsupported = unsupported(frames, evidence.T_map_body);
  health.restarts = frames.restarts;
  health.gaps = gaps_of(evidence);
  health.leaps = leaps_of(evidence, frames.is_corrected);
  health.skipped_records = evidence.skipped_records;
  const std::size_t records = evidence.skipped_records + evidence.read_records;
  if (records > 0) {
    health.skipped_share =
        static_cast<double>(evidence.skipped_records) / static_cast<double>(records);
  }
  health.sensors = evidence.sensors.empty() ? frames.sensors : evidence.sensors;
  for (SensorUse& sensor : health.sensors) {
    for (const SensorUse& seen : frames.sensors) {
      if (seen.kind == sensor.kind) sensor.longest_rejected_s = seen.longest_rejected_s;
    }
  }
  health.contradictions = evidence.contradictions;
  add_times(evidence, health);

  Reasons reasons;
  judge_registration(health, frames, reasons);
  judge_motion(health, frames, shaking_of(evidence, frames.is_corrected), reasons);
  for (const SensorUse& sensor : health.sensors)
    judge_sensor(sensor, frames.is_navigation, reasons);
  judge_recording(health, reasons);
  judge_error(evidence, health, reasons);
  for (const HealthReason& trouble : evidence.troubles) {
    if (trouble.code == "not_deskewed" && has_found(evidence, "point_times_unknown")) continue;
    reasons.add(trouble.severity, trouble.code, trouble.text);
  }
  for (const Contradiction& found : evidence.contradictions) {
    if (found.severity != Health::kOk) reasons.add(found.severity, found.code, found.text);
  }
  health.reasons = reasons.take();
  if (!health.reasons.empty()) health.verdict = health.reasons.front().severity;
  return health;
}

}  // namespace traverse::pipeline
