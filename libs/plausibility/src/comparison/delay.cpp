#include "comparison/delay.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "traverse/statistics/quantile.hpp"

namespace traverse::plausibility {

namespace {

constexpr std::size_t kMinComparedPieces = 20;
constexpr std::size_t kMaxComparedPieces = 200;

/// What is left of each piece after a scale and a bias that all have in common, which are no delay.
struct Comparison {
  std::vector<double> differences;  // NaN where there is nothing to compare with
  Misfit misfit;
};

/// The slope of least squares of the pieces over what the other stream tells.
double slope_of(const std::vector<TimedPiece>& pieces, const std::vector<double>& told) {
  double n = 0;
  double x = 0;
  double y = 0;
  double xy = 0;
  double yy = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (!std::isfinite(told[i])) continue;
    ++n;
    x += pieces[i].value;
    y += told[i];
    xy += pieces[i].value * told[i];
    yy += told[i] * told[i];
  }
  const double variance = yy - y * y / std::max(n, 1.0);
  return variance > 1e-9 * yy ? (xy - x * y / n) / variance : 0;
}

Comparison compare(const std::vector<TimedPiece>& pieces, const MotionSource& other, double delay) {
  Comparison result;
  std::vector<double> told;
  for (const TimedPiece& piece : pieces) {
    told.push_back(other.between(piece.t0 - delay, piece.t1 - delay)
                       .value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  const double slope = slope_of(pieces, told);
  std::vector<double> present;
  double values = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    result.differences.push_back(pieces[i].value - slope * told[i]);
    if (!std::isfinite(told[i])) continue;
    present.push_back(result.differences.back());
    values += std::abs(pieces[i].value);
  }
  result.misfit.pieces = present.size();
  if (present.empty() || !(values > 0)) return result;
  const double bias = statistics::element_at_share(present, 0.5);
  double sum = 0;
  for (double& difference : result.differences) {
    difference = std::abs(difference - bias);
    if (std::isfinite(difference)) sum += difference;
  }
  result.misfit.mean = sum / values;
  return result;
}

/// By how many standard errors what is left is smaller `there`, piece by piece.
double gain_in_sigmas(const Comparison& at_zero, const Comparison& there) {
  double sum = 0;
  double squares = 0;
  double n = 0;
  for (std::size_t i = 0; i < at_zero.differences.size(); ++i) {
    const double gain = at_zero.differences[i] - there.differences[i];
    if (!std::isfinite(gain)) continue;
    sum += gain;
    squares += gain * gain;
    ++n;
  }
  if (n < 2) return 0;
  const double variance = squares / n - sum * sum / n / n;
  return variance > 0 ? sum / n / std::sqrt(variance / n) : 0;
}

/// Among pieces that can be compared at any delay within reach.
std::optional<Delay> search_delay(std::vector<TimedPiece> pieces, const MotionSource& other,
                                  double reach_s) {
  if (pieces.size() < kMinComparedPieces) return std::nullopt;
  const double reach = std::min(reach_s, (pieces.back().t1 - pieces.front().t0) / 4);
  std::erase_if(pieces, [&](const TimedPiece& piece) {
    return !other.between(piece.t0 - reach, piece.t1 + reach);
  });
  if (pieces.size() < kMinComparedPieces) return std::nullopt;
  const std::size_t step = pieces.size() / kMaxComparedPieces + 1;
  std::vector<TimedPiece> compared;
  for (std::size_t i = 0; i < pieces.size(); i += step) compared.push_back(pieces[i]);

  Delay best;
  const Comparison at_zero = compare(compared, other, 0);
  Comparison there = at_zero;
  const auto search = [&](double from, double to, double width) {
    const int steps = static_cast<int>(std::round((to - from) / width));
    for (int k = 0; k <= steps; ++k) {
      const double delay = std::clamp(from + k * width, -reach, reach);
      Comparison here = compare(compared, other, delay);
      if (here.misfit.mean >= there.misfit.mean) continue;
      there = std::move(here);
      best.seconds = delay;
    }
  };
  const double coarse = std::max(reach / 40, 0.01);
  search(-reach, reach, coarse);
  search(best.seconds - coarse, best.seconds + coarse, coarse / 8);
  search(best.seconds - coarse / 8, best.seconds + coarse / 8, coarse / 40);
  best.at_zero = at_zero.misfit;
  best.there = there.misfit;
  best.gain_sigmas = gain_in_sigmas(at_zero, there);
  return best;
}

}  // namespace

bool Delay::is_marked(double min_s) const {
  const bool is_better = there.mean < 0.7 * at_zero.mean && gain_sigmas > 4;
  const bool is_far_better = there.mean < 0.25 * at_zero.mean && gain_sigmas > 2;
  return std::abs(seconds) > min_s && (is_better || is_far_better);
}

std::optional<Delay> find_delay(const std::vector<TimedPiece>& pieces, const MotionSource& other,
                                double reach_s) {
  constexpr double kNear_s = 1;  // where it is likely, in small steps and on nearly all pieces
  auto near = search_delay(pieces, other, std::min(kNear_s, reach_s));
  if (reach_s <= kNear_s) return near;
  auto far = search_delay(pieces, other, reach_s);
  const auto left = [](const Delay& delay) { return delay.there.mean / delay.at_zero.mean; };
  const bool is_far = far && (!near || left(*far) < 0.8 * left(*near));
  return is_far ? far : near;
}

}  // namespace traverse::plausibility
