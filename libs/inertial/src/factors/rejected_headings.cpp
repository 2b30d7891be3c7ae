#include "factors/rejected_headings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace traverse::inertial {

using geometry::seconds_between;

void RejectedHeadings::add(geometry::Stamp stamp, double residual, double sigma, bool is_rejected) {
  constexpr std::size_t kMost = 200;
  headings_.push_back({stamp, residual, sigma, is_rejected});
  if (headings_.size() > kMost) headings_.pop_front();
}

std::optional<double> RejectedHeadings::offset(double seconds) const {
  constexpr std::size_t kLeast = 4;
  constexpr double kAlike = 3.3;  // deviations, 0.1 %
  if (headings_.size() < kLeast) return std::nullopt;
  const geometry::Stamp newest = headings_.back().stamp;
  if (seconds_between(headings_.front().stamp, newest) < seconds) return std::nullopt;
  auto first = headings_.end() - kLeast;
  while (first != headings_.begin() &&
         seconds_between(std::prev(first)->stamp, newest) <= seconds) {
    --first;
  }
  const auto count = headings_.end() - first;
  const auto rejected =
      std::count_if(first, headings_.end(), [](const Heading& h) { return h.is_rejected; });
  if (2 * rejected <= count) return std::nullopt;
  for (auto middle = first; middle != headings_.end(); ++middle) {
    std::ptrdiff_t alike = 0;
    double sum = 0;
    for (auto other = first; other != headings_.end(); ++other) {
      const double apart = std::remainder(other->residual - middle->residual, 2 * std::numbers::pi);
      if (std::abs(apart) > kAlike * std::hypot(other->sigma, middle->sigma)) continue;
      ++alike;
      sum += apart;
    }
    if (2 * alike > count) {
      return std::remainder(middle->residual + sum / static_cast<double>(alike),
                            2 * std::numbers::pi);
    }
  }
  return std::nullopt;
}

}  // namespace traverse::inertial
