#include "frame_evidence.hpp"

#include <algorithm>
#include <string>

namespace traverse::pipeline {

namespace {

/// A pose that no fix has held for longer is corrected by the next one, and may step.
constexpr double kHeldByFix_s = 1;

double seconds(const geometry::Trajectory& path, std::size_t from, std::size_t to) {
  return geometry::seconds_between(path.stamp(from), path.stamp(to));
}

bool is_same_pose(const geometry::Pose3& a, const geometry::Pose3& b) {
  return a.translation == b.translation && a.rotation == b.rotation;
}

void count_registration(const geometry::Trajectory& path, const std::vector<bool>& may_be,
                        const std::vector<bool>& is_held, FrameEvidence& evidence) {
  for (std::size_t i = 0; i < may_be.size(); ++i) {
    evidence.is_lost[i] = may_be[i] && !is_held[i];
    if (!may_be[i]) continue;
    ++evidence.registrable;
    if (!is_held[i]) continue;
    ++evidence.registered;
    if (i > 0 && is_same_pose(path.pose(i - 1), path.pose(i))) ++evidence.frozen;
  }
}

void read_lidar(const FrameTable& frames, const geometry::Trajectory& path,
                FrameEvidence& evidence) {
  const std::vector<double> registered = frames.column("registered");
  // Of odometry in two stages the first alone may have moved the pose.
  const std::vector<double> by_odometry = frames.column("odometry_registered");
  const std::vector<double> degenerate = frames.column("degenerate_directions");
  std::vector<bool> may_be(registered.size(), true);
  std::vector<bool> is_held(registered.size(), false);
  for (std::size_t i = 0; i < registered.size(); ++i) {
    is_held[i] = registered[i] != 0 || (!by_odometry.empty() && by_odometry[i] != 0);
    if (i == 0) may_be[i] = false;  // it defines the map
    if (i == 0 || !is_held[i] || degenerate.empty()) continue;
    evidence.is_degenerate[i] = degenerate[i] > 0;
  }
  count_registration(path, may_be, is_held, evidence);
}

/// A kind of factor whose readings a gate may reject, as the columns tell it.
struct Gated {
  explicit Gated(const FrameTable& frames, const std::string& prefix)
      : rows(frames.column(prefix + "_rows")), rejected(frames.column(prefix + "_rejected")) {}

  bool was_taken(std::size_t i) const { return !rows.empty() && rows[i] > 0 && rejected[i] == 0; }
  bool was_rejected(std::size_t i) const {
    return !rows.empty() && rows[i] > 0 && rejected[i] != 0;
  }

  std::vector<double> rows;
  std::vector<double> rejected;
};

/// \param kinds whose readings are those of one sensor
SensorUse use_of(sensors::SensorKind kind, const std::vector<const Gated*>& kinds,
                 const geometry::Trajectory& path) {
  SensorUse use;
  use.kind = kind;
  use.label = sensors::name_of(kind);
  std::optional<std::size_t> rejected_since;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const auto any = [&](auto question) {
      return std::any_of(kinds.begin(), kinds.end(),
                         [&](const Gated* gated) { return (gated->*question)(i); });
    };
    if (any(&Gated::was_taken)) {
      ++use.used;
      rejected_since.reset();
    } else if (any(&Gated::was_rejected)) {
      ++use.rejected;
      if (!rejected_since) rejected_since = i;
      use.longest_rejected_s = std::max(use.longest_rejected_s, seconds(path, *rejected_since, i));
    }
  }
  return use;
}

void read_navigation(const FrameTable& frames, const geometry::Trajectory& path,
                     FrameEvidence& evidence) {
  const Gated gnss(frames, "gnss");
  const Gated wheels(frames, "wheels");
  const Gated standing(frames, "standing");
  const std::vector<double> in_outage = frames.column("in_outage");
  evidence.is_navigation = true;
  evidence.sensors = {use_of(sensors::SensorKind::kGnss, {&gnss}, path),
                      use_of(sensors::SensorKind::kWheels, {&wheels, &standing}, path)};
  evidence.knows_place = evidence.sensors.front().used > 0;
  std::vector<bool> may_be(path.size(), true);
  std::vector<bool> is_held(path.size(), false);
  std::optional<std::size_t> last_fix;
  for (std::size_t i = 0; i < path.size(); ++i) {
    may_be[i] = i > 0 && (in_outage.empty() || in_outage[i] == 0);
    is_held[i] = gnss.was_taken(i) || wheels.was_taken(i) || standing.was_taken(i);
    if (!gnss.was_taken(i)) continue;
    evidence.is_corrected[i] = last_fix && seconds(path, *last_fix, i) > kHeldByFix_s;
    last_fix = i;
  }
  count_registration(path, may_be, is_held, evidence);
}

void read_localization(const FrameTable& frames, FrameEvidence& evidence) {
  const std::vector<double> located = frames.column("located");
  evidence.located = 0;
  evidence.knows_place = true;
  for (std::size_t i = 0; i < located.size(); ++i) {
    if (located[i] == 0) continue;
    // The frames before the first that was found wait for it and are placed with it.
    *evidence.located += *evidence.located == 0 ? i + 1 : 1;
    if (i > 0 && located[i - 1] == 0) evidence.is_corrected[i] = true;
  }
}

}  // namespace

FrameEvidence read_frame_evidence(const FrameTable& frames,
                                  const geometry::Trajectory& T_map_body) {
  FrameEvidence evidence;
  for (const double number : frames.column("frame")) {
    evidence.numbers.push_back(static_cast<std::size_t>(number));
  }
  const std::size_t count = T_map_body.size();
  evidence.is_lost.assign(count, false);
  evidence.is_degenerate.assign(count, false);
  evidence.is_corrected.assign(count, false);
  if (count == 0) return evidence;
  if (frames.has("registered")) read_lidar(frames, T_map_body, evidence);
  if (frames.has("gnss_rows")) read_navigation(frames, T_map_body, evidence);
  if (frames.has("located")) read_localization(frames, evidence);
  const std::vector<double> restarted = frames.column("restarted");
  for (std::size_t i = 0; i < restarted.size(); ++i) {
    if (restarted[i] == 0) continue;
    ++evidence.restarts;
    evidence.is_corrected[i] = true;
  }
  return evidence;
}

}  // namespace traverse::pipeline
