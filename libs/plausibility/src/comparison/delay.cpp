#include "comparison/delay.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "traverse/statistics/quantile.hpp"

namespace traverse::plausibility {

namespace {

constexpr std::size_t kMinComparedPieces = 20;
constexpr std::size_t kMaxComparedPieces = 400;

/// What is left of each piece: the bias of a gyro is the same in all of them and taken off.
struct Comparison {
  std::vector<double> differences;  // NaN where there is nothing to compare with
  Misfit misfit;
};

Comparison compare(const std::vector<TimedPiece>& pieces, const MotionSource& other, double scale,
                   double delay) {
  Comparison result;
  std::vector<double> present;
  double values = 0;
  for (const TimedPiece& piece : pieces) {
    const auto told = other.between(piece.t0 - delay, piece.t1 - delay);
    result.differences.push_back(told ? piece.value - scale * *told
                                      : std::numeric_limits<double>::quiet_NaN());
    if (!told) continue;
    present.push_back(result.differences.back());
    values += std::abs(piece.value);
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

}  // namespace

bool Delay::is_marked(double min_s) const {
  return std::abs(seconds) > min_s && there.mean < 0.7 * at_zero.mean && gain_sigmas > 4;
}

std::optional<Delay> find_delay(std::vector<TimedPiece> pieces, const MotionSource& other,
                                double scale, double reach_s) {
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
  const Comparison at_zero = compare(compared, other, scale, 0);
  Comparison there = at_zero;
  const auto search = [&](double from, double to, double width) {
    const int steps = static_cast<int>(std::round((to - from) / width));
    for (int k = 0; k <= steps; ++k) {
      const double delay = std::clamp(from + k * width, -reach, reach);
      Comparison here = compare(compared, other, scale, delay);
      if (here.misfit.mean >= there.misfit.mean) continue;
      there = std::move(here);
      best.seconds = delay;
    }
  };
  const double coarse = std::max(reach / 60, 0.01);
  search(-reach, reach, coarse);
  search(best.seconds - coarse, best.seconds + coarse, coarse / 8);
  search(best.seconds - coarse / 8, best.seconds + coarse / 8, coarse / 40);
  best.at_zero = at_zero.misfit;
  best.there = there.misfit;
  best.gain_sigmas = gain_in_sigmas(at_zero, there);
  return best;
}

}  // namespace traverse::plausibility
