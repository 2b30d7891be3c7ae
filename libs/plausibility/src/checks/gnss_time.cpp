#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "checks/check.hpp"
#include "comparison/delay.hpp"
#include "comparison/place_judgement.hpp"
#include "comparison/ratio.hpp"

namespace traverse::plausibility {

namespace {

// Receivers tell where they were 50 to 150 ms ago; 18 s lie between the clocks of GPS and UTC.
constexpr std::array<CodeMeaning, 1> kGnssTimeCodes{
    {{"gnss_late",
      "Distances and turns between fixes against those of lidar odometry, wheels or gyro, shifted "
      "in "
      "time by up to 30 s: more than 0.2 s away they agree better by three tenths and four "
      "sigma."}}};

constexpr double kMinGnssDelay_s = 0.2;
constexpr double kCertainlyAnotherClock_s = 1;
constexpr double kFarthestClock_s = 30;

struct FoundDelay {
  Delay delay;
  std::string against;
};

/// The delay at which most is gained, of those against any other stream.
class BestDelay {
 public:
  void look(const std::vector<TimedPiece>& pieces, const MotionSource& other, double scale) {
    const auto delay = find_delay(pieces, other, scale, kFarthestClock_s);
    if (!delay || !delay->is_marked(kMinGnssDelay_s)) return;
    const auto gain = [](const Delay& d) { return d.at_zero.mean / d.there.mean; };
    if (!best_ || gain(*delay) > gain(best_->delay)) best_ = {*delay, other.name};
  }
  const std::optional<FoundDelay>& best() const { return best_; }

 private:
  std::optional<FoundDelay> best_;
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
    // A scale does not depend on a delay.
    Ratio ratio;
    for (const TimedPiece& piece : pieces) {
      if (const auto way = size.between(piece.t0, piece.t1)) ratio.add(piece.value, *way);
    }
    const auto scale = ratio.find(10, 20);
    if (scale && scale->is_near(1)) best.look(pieces, size, 1 / scale->value);
  }
}

void look_by_turn(const Evidence& evidence, const Legs& legs, BestDelay& best) {
  std::vector<TimedPiece> pieces;
  for (const CourseTurn& turn : all_course_turns(legs)) {
    pieces.push_back({turn.t0, turn.t1, turn.turn});
  }
  for (const MotionSource& source : other_turns(evidence)) best.look(pieces, source, 1);
  for (const auto& [label, track] : evidence.imus) {
    if (!track.turn().empty()) best.look(pieces, gyro_turn(evidence, label), 1);
  }
}

void look_at_delay(const View& view, std::vector<Finding>& findings) {
  const Evidence& evidence = view.evidence;
  for (const auto& [label, receiver] : view.receivers) {
    const Legs& legs = receiver.legs;
    BestDelay best;
    look_by_distance(evidence, legs, best);
    look_by_turn(evidence, legs, best);
    if (!best.best()) continue;
    const Delay& delay = best.best()->delay;
    const double seconds = std::abs(delay.seconds);
    findings.push_back(
        {"gnss_late", seconds > kCertainlyAnotherClock_s ? Severity::kRefuse : Severity::kWarn,
         label,
         fmt::format("its fixes go best with {} as places of {:.2f} s {} their stamps: the mean "
                     "difference is then {:.1f} %, else {:.1f} %, over {} pieces",
                     best.best()->against, seconds, delay.seconds > 0 ? "before" : "after",
                     100 * delay.there.mean, 100 * delay.at_zero.mean, delay.there.pieces),
         std::abs(seconds - 18) < 0.5
             ? std::string("One clock is GPS time, the other UTC: 18 leap seconds lie between")
             : fmt::format("At 10 m/s the path and the fixes would be {:.1f} m apart",
                           10 * seconds),
         fmt::format("--recording gnss.delay_s={:.2f}", delay.seconds)});
  }
}

}  // namespace

const Check kGnssTime{kGnssTimeCodes, look_at_delay};

}  // namespace traverse::plausibility
