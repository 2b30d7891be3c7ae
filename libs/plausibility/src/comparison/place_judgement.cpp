#include "comparison/place_judgement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "comparison/motion_sources.hpp"
#include "comparison/ratio.hpp"

namespace traverse::plausibility {

namespace {

constexpr double kDegree = 57.29578;
constexpr std::size_t kMinLegsCompared = 5;
constexpr double kMinLengthCompared_m = 20;

/// Distances of another stream over those of the legs, and how far they are from 1, in logarithms.
struct LengthFit {
  Ratio::Result ratio;
  std::string against;
};

std::optional<LengthFit> length_fit(const Evidence& evidence, const Legs& legs) {
  std::vector<MotionSource> sources;
  if (auto odometry = odometry_distance(evidence)) sources.push_back(std::move(*odometry));
  for (const auto& [label, track] : evidence.wheels) {
    if (!track.distance().empty()) sources.push_back(wheel_distance(evidence, label));
  }
  for (const MotionSource& source : sources) {
    Ratio ratio;
    for (const Leg& leg : legs.legs) {
      const auto way = source.between(leg.t0, leg.t1);
      if (way) ratio.add(leg.length_m(), std::abs(*way));
    }
    const auto found = ratio.find(kMinLegsCompared, kMinLengthCompared_m);
    if (found) return LengthFit{*found, source.name};
  }
  return std::nullopt;
}

/// Turns of the course over those of the first stream that tells them.
std::optional<LengthFit> turn_fit(const Evidence& evidence, const Legs& legs) {
  constexpr std::size_t kMinTurns = 4;
  constexpr double kMinTurn = 1;  // rad
  std::vector<MotionSource> sources = other_turns(evidence);
  for (const auto& [label, track] : evidence.imus) {
    if (!track.turn().empty()) sources.push_back(gyro_turn(evidence, label));
  }
  const std::vector<CourseTurn> turns = course_turns(legs);
  for (const MotionSource& source : sources) {
    Ratio ratio;
    for (const CourseTurn& turn : turns) {
      const auto other = source.between(turn.t0, turn.t1);
      if (other) ratio.add(turn.turn, *other);
    }
    const auto found = ratio.find(kMinTurns, kMinTurn);
    if (found) return LengthFit{*found, source.name};
  }
  return std::nullopt;
}

bool is_within(double value, double expected, double factor) {
  return value / expected > 1 / factor && value / expected < factor;
}

std::optional<PlaceJudgement> judge_radians(const Evidence& evidence, const GnssTrack& track,
                                            double delay_s) {
  // Places in radians read as degrees lie in the Gulf of Guinea, within 180 km of the equator.
  constexpr double kNoPlace = 0.02;  // simulators begin at 0, 0
  for (const TimedFix& fix : track.fixes()) {
    if (std::abs(fix.latitude) > M_PI / 2 || std::abs(fix.longitude) > M_PI) return std::nullopt;
    if (std::hypot(fix.latitude, fix.longitude) < kNoPlace) return std::nullopt;
  }
  const auto as_read = length_fit(evidence, legs_of(track, PlaceReading::kAsRead, delay_s));
  if (as_read && is_within(as_read->ratio.value, 1, 3)) return std::nullopt;
  const auto fit = length_fit(evidence, legs_of(track, PlaceReading::kRadians, delay_s));
  if (fit && !is_within(fit->ratio.value, 1, 2)) return std::nullopt;
  const TimedFix& first = track.fixes().front();
  std::string figure =
      fmt::format("all places are near latitude {:.4f}, longitude {:.4f}, in the Gulf of Guinea",
                  first.latitude, first.longitude);
  if (fit) {
    figure += fmt::format("; read as radians their distances are {:.2f} times those of {}",
                          1 / fit->ratio.value, fit->against);
  }
  return PlaceJudgement{PlaceReading::kRadians, std::move(figure), fit.has_value()};
}

std::optional<PlaceJudgement> judge_minutes(const Evidence& evidence, const GnssTrack& track,
                                            double delay_s) {
  const auto is_minutes = [](double value) {
    return std::abs(value) - std::floor(std::abs(value)) < 0.6;
  };
  for (const TimedFix& fix : track.fixes()) {
    if (!is_minutes(fix.latitude) || !is_minutes(fix.longitude)) return std::nullopt;
  }
  const auto as_read = length_fit(evidence, legs_of(track, PlaceReading::kAsRead, delay_s));
  if (!as_read || !is_within(as_read->ratio.value, 100.0 / 60, 1.1)) return std::nullopt;
  const auto fit = length_fit(evidence, legs_of(track, PlaceReading::kDegreesMinutes, delay_s));
  if (!fit || !is_within(fit->ratio.value, 1, 1.1)) return std::nullopt;
  return PlaceJudgement{
      PlaceReading::kDegreesMinutes,
      fmt::format("distances between fixes are {:.2f} times those of {}, which degrees and minutes "
                  "(ddmm.mmmm / 100) read as degrees give: 0.60; no place has a fraction above 0.6",
                  1 / as_read->ratio.value, as_read->against),
      true};
}

std::optional<PlaceJudgement> judge_swapped(const Evidence& evidence, const GnssTrack& track,
                                            double delay_s) {
  const Legs as_read = legs_of(track, PlaceReading::kAsRead, delay_s);
  const Legs swapped = legs_of(track, PlaceReading::kSwapped, delay_s);
  if (swapped.legs.size() < kMinLegsCompared) return std::nullopt;
  // A map with east and north exchanged is its own mirror image: it turns the other way. Its metres
  // are off by the cosines of two latitudes, one way along the equator and not at all across.
  const auto turns = turn_fit(evidence, as_read);
  const auto swapped_turns = turn_fit(evidence, swapped);
  const bool is_mirrored = turns && turns->ratio.negative_share > 0.85 && swapped_turns &&
                           swapped_turns->ratio.is_consistent() && swapped_turns->ratio.is_near(1);
  if (!is_mirrored) return std::nullopt;
  std::string figure = fmt::format("the course turns the other way than {}", turns->against);
  const auto lengths = length_fit(evidence, as_read);
  const auto swapped_lengths = length_fit(evidence, swapped);
  const auto misfit = [](const LengthFit& fit) {
    return std::abs(std::log(std::abs(fit.ratio.value))) + fit.ratio.spread;
  };
  if (lengths && swapped_lengths && misfit(*lengths) > 0.05 &&
      misfit(*swapped_lengths) < misfit(*lengths) / 2) {
    figure += fmt::format(
        ", and distances between fixes are {:.2f} times those of {} (half of them within {:.0f} "
        "%); "
        "with latitude and longitude exchanged both agree ({:.2f})",
        1 / lengths->ratio.value, lengths->against, 100 * lengths->ratio.spread,
        1 / swapped_lengths->ratio.value);
    return PlaceJudgement{PlaceReading::kSwapped, std::move(figure), true};
  }
  const auto heading = heading_agreement(track, legs_of(track, PlaceReading::kAsRead, 0), 1, 1);
  const auto swapped_heading =
      heading_agreement(track, legs_of(track, PlaceReading::kSwapped, 0), 1, 1);
  if (heading.share < 0.4 && swapped_heading.share > 0.6) {
    figure += "; with latitude and longitude exchanged it agrees, and with the headings too";
    return PlaceJudgement{PlaceReading::kSwapped, std::move(figure), true};
  }
  return std::nullopt;
}

}  // namespace

PlaceJudgement judge_places(const Evidence& evidence, const GnssTrack& track, double delay_s) {
  if (track.fixes().size() < kMinLegsCompared) return {};
  if (auto radians = judge_radians(evidence, track, delay_s)) return *radians;
  if (auto minutes = judge_minutes(evidence, track, delay_s)) return *minutes;
  if (auto swapped = judge_swapped(evidence, track, delay_s)) return *swapped;
  return {};
}

HeadingAgreement heading_agreement(const GnssTrack& track, const Legs& legs, double sense,
                                   double unit_deg) {
  constexpr double kNear_deg = 15;
  std::vector<double> offsets_deg;
  std::vector<double> courses_deg;
  const std::vector<TimedFix>& fixes = track.fixes();
  for (const Leg& leg : legs.legs) {
    auto fix = std::lower_bound(fixes.begin(), fixes.end(), leg.middle_s(),
                                [](const TimedFix& f, double t) { return f.t < t; });
    if (fix != fixes.begin() && leg.middle_s() - std::prev(fix)->t < fix->t - leg.middle_s()) --fix;
    if (fix == fixes.end() || !fix->heading || fix->t < leg.t0 || fix->t > leg.t1) continue;
    const double course_deg = 90 - kDegree * leg.course();
    offsets_deg.push_back(kDegree *
                          wrapped((unit_deg * *fix->heading - sense * course_deg) / kDegree));
    courses_deg.push_back(course_deg);
  }
  HeadingAgreement agreement;
  agreement.legs = offsets_deg.size();
  if (offsets_deg.empty()) return agreement;
  const auto difference = [](double a, double b) { return kDegree * wrapped((a - b) / kDegree); };
  // The offset that most legs are near to: the mean of those near the fullest of 72 directions.
  const auto fullest = [&](const std::vector<double>& angles_deg) {
    double best = 0;
    std::size_t most = 0;
    for (int bin = 0; bin < 72; ++bin) {
      const double centre = 5.0 * bin;
      double sum = 0;
      std::size_t count = 0;
      for (const double angle : angles_deg) {
        const double off = difference(angle, centre);
        if (std::abs(off) > kNear_deg) continue;
        sum += off;
        ++count;
      }
      if (count > most) {
        most = count;
        best = centre + sum / static_cast<double>(count);
      }
    }
    return std::pair(best, most);
  };
  const auto [offset, near] = fullest(offsets_deg);
  agreement.offset_deg = difference(offset, 0);
  agreement.share = static_cast<double>(near) / static_cast<double>(offsets_deg.size());
  const auto [course, near_course] = fullest(courses_deg);
  std::vector<double> spread;
  for (const double angle : courses_deg) spread.push_back(std::abs(difference(angle, course)));
  std::nth_element(spread.begin(), spread.begin() + static_cast<std::ptrdiff_t>(spread.size() / 2),
                   spread.end());
  agreement.course_deg = spread[spread.size() / 2];
  return agreement;
}

}  // namespace traverse::plausibility
