#include "comparison/receiver_delay.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include "comparison/motion_sources.hpp"

namespace traverse::plausibility {

namespace {

/// The delay at which most is gained.
class BestDelay {
 public:
  /// \param doubt_s what the delay is not known by, for another reason than noise
  void look(const std::vector<TimedPiece>& pieces, const MotionSource& other, double doubt_s) {
    constexpr double kMinDelay_s = 0.2;
    constexpr double kFarthest_s = 30;
    const auto delay = find_delay(pieces, other, kFarthest_s);
    if (!delay || !delay->is_marked(kMinDelay_s + doubt_s)) return;
    const auto gain = [](const Delay& d) { return d.at_zero.mean / d.there.mean; };
    if (!best_ || gain(*delay) > gain(best_->delay)) best_ = {*delay, other.name};
  }
  const std::optional<ReceiverDelay>& best() const { return best_; }

 private:
  std::optional<ReceiverDelay> best_;
};

void look_by_distance(const Evidence& evidence, const Legs& legs, BestDelay& best) {
  std::vector<TimedPiece> pieces;
  for (const Leg& leg : legs.legs) pieces.push_back({leg.t0, leg.t1, leg.length_m()});
  std::vector<MotionSource> sources;
  if (auto odometry = odometry_distance(evidence)) sources.push_back(std::move(*odometry));
  for (const auto& [label, track] : evidence.wheels) {
    if (!track.distance().empty()) sources.push_back(wheel_distance(evidence, label));
  }
  for (const MotionSource& source : sources) {
    const MotionSource size{source.name, [&source](double t0, double t1) {
                              auto way = source.between(t0, t1);
                              if (way) *way = std::abs(*way);
                              return way;
                            }};
    best.look(pieces, size, 0);
  }
}

/// How far the antenna is ahead of the axle whose wheels do not steer, and by how much that may be
/// wrong: where neither is known, two metres of a car are.
struct LeverArm {
  double ahead_m = 0;
  double doubt_m = 2;
};

LeverArm lever_arm(const sensors::Rig& rig, const std::string& receiver) {
  const auto* antenna = rig.find(receiver);
  const auto* wheels = rig.first(sensors::SensorKind::kWheels);
  if (antenna == nullptr || wheels == nullptr) return {};
  const double ahead_m =
      antenna->T_body_sensor.translation.x() - wheels->T_body_sensor.translation.x();
  return ahead_m != 0 ? LeverArm{ahead_m, 0} : LeverArm{};
}

/// What is ahead of the axle goes where the body will point to once it is there: its course is
/// ahead of the heading by that way.
void look_by_turn(const Evidence& evidence, const Legs& legs, const LeverArm& arm,
                  BestDelay& best) {
  double metres = 0;
  double seconds = 0;
  for (const Leg& leg : legs.legs) {
    metres += leg.length_m();
    seconds += leg.t1 - leg.t0;
  }
  if (!(metres > 0)) return;
  const double ahead_s = arm.ahead_m * seconds / metres;
  const double doubt_s = arm.doubt_m * seconds / metres;
  std::vector<TimedPiece> pieces;
  for (const CourseTurn& turn : all_course_turns(legs)) {
    pieces.push_back({turn.t0 + ahead_s, turn.t1 + ahead_s, turn.turn});
  }
  for (const MotionSource& source : other_turns(evidence)) best.look(pieces, source, doubt_s);
  for (const auto& [label, track] : evidence.imus) {
    if (!track.turn().empty()) best.look(pieces, gyro_turn(evidence, label), doubt_s);
  }
}

}  // namespace

std::optional<ReceiverDelay> find_receiver_delay(const Evidence& evidence,
                                                 const std::string& receiver, const Legs& legs) {
  BestDelay best;
  look_by_distance(evidence, legs, best);
  look_by_turn(evidence, legs, lever_arm(evidence.recording.rig, receiver), best);
  return best.best();
}

}  // namespace traverse::plausibility
