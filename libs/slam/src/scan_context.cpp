#include "traverse/slam/scan_context.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace traverse::slam {

void bind(config::Binder& b, ScanContextOptions& o) {
  using config::Range;
  b.integer("rings", o.rings, Range::between(4, 200),
            "rings of the ground plane around the sensor");
  b.integer("sectors", o.sectors, Range::between(8, 720), "sectors of each ring");
  b.number("reach_m", o.reach_m, Range::positive(), "radius of the outermost ring");
  b.number("floor_m", o.floor_m, Range::any(),
           "added to heights, so that the ground below the sensor is near zero");
}

ScanContext::ScanContext(std::span<const float> x, std::span<const float> y,
                         std::span<const float> z, const ScanContextOptions& options)
    : rings_(static_cast<std::size_t>(options.rings)),
      sectors_(static_cast<std::size_t>(options.sectors)),
      heights_(rings_ * sectors_, 0),
      ring_key_(rings_, 0) {
  const double per_m = options.rings / options.reach_m;
  const double per_rad = options.sectors / (2 * std::numbers::pi);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double rings_off = std::hypot(x[i], y[i]) * per_m;
    if (!(rings_off < options.rings)) continue;
    const auto ring = static_cast<std::size_t>(rings_off);
    const double azimuth = std::atan2(y[i], x[i]) + std::numbers::pi;
    const auto sector = std::min(static_cast<std::size_t>(azimuth * per_rad), sectors_ - 1);
    float& height = heights_[sector * rings_ + ring];
    height = std::max(height, z[i] + static_cast<float>(options.floor_m));
  }
  for (std::size_t s = 0; s < sectors_; ++s) {
    double squared = 0;
    for (std::size_t r = 0; r < rings_; ++r) {
      const float height = heights_[s * rings_ + r];
      if (height > 0) ring_key_[r] += 1.0F / static_cast<float>(sectors_);
      squared += static_cast<double>(height) * height;
    }
    if (squared == 0) continue;
    const auto scale = static_cast<float>(1 / std::sqrt(squared));
    for (std::size_t r = 0; r < rings_; ++r) heights_[s * rings_ + r] *= scale;
  }
}

ScanContext::Match ScanContext::compare(const ScanContext& first, const ScanContext& second) {
  Match best;
  const std::size_t sectors = first.sectors_;
  const std::size_t rings = first.rings_;
  const auto is_empty = [&](const ScanContext& context, std::size_t sector) {
    const auto column = context.heights_.begin() + static_cast<std::ptrdiff_t>(sector * rings);
    return std::all_of(column, column + static_cast<std::ptrdiff_t>(rings),
                       [](float height) { return height == 0; });
  };
  std::vector<char> empty_first(sectors);
  std::vector<char> empty_second(sectors);
  for (std::size_t s = 0; s < sectors; ++s) {
    empty_first[s] = is_empty(first, s) ? 1 : 0;
    empty_second[s] = is_empty(second, s) ? 1 : 0;
  }
  for (std::size_t shift = 0; shift < sectors; ++shift) {
    double cosines = 0;
    std::size_t columns = 0;
    for (std::size_t s = 0; s < sectors; ++s) {
      const std::size_t other = (s + shift) % sectors;
      if (empty_first[s] != 0 || empty_second[other] != 0) continue;
      const float* a = &first.heights_[s * rings];
      const float* b = &second.heights_[other * rings];
      float dot = 0;
      for (std::size_t r = 0; r < rings; ++r) dot += a[r] * b[r];
      cosines += static_cast<double>(dot);
      ++columns;
    }
    // Places that share few directions would win by chance.
    if (columns < sectors / 4) continue;
    const double distance = 1 - cosines / static_cast<double>(columns);
    if (distance >= best.distance) continue;
    best.distance = distance;
    const double turn =
        -2 * std::numbers::pi * static_cast<double>(shift) / static_cast<double>(sectors);
    best.turn_rad = std::remainder(turn, 2 * std::numbers::pi);
  }
  return best;
}

}  // namespace traverse::slam
