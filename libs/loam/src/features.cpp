#include "traverse/loam/features.hpp"

#include <algorithm>
#include <cmath>

#include "curvature.hpp"

namespace traverse::loam {

namespace {

constexpr std::size_t kSuppressedNeighbours = 5;  // no two picked features closer than this

/// Distance of each point to the next, metres; across the end of a line it means nothing.
std::vector<float> steps(const lidar::ScanLines& lines) {
  std::vector<float> step(lines.size(), 0);
  for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
    const float dx = lines.x[i + 1] - lines.x[i];
    const float dy = lines.y[i + 1] - lines.y[i];
    const float dz = lines.z[i + 1] - lines.z[i];
    step[i] = std::sqrt(dx * dx + dy * dy + dz * dz);
  }
  return step;
}

/// Works on one scan at a time; the vectors below are indexed like ScanLines.
class Picker {
 public:
  Picker(const lidar::ScanLines& lines, const FeatureOptions& options)
      : lines_(lines),
        options_(options),
        curvature_(curvature(lines)),
        step_(steps(lines)),
        blocked_(lines.size(), 0),
        beside_flat_(lines.size(), 0),
        breaks_after_(lines.size(), 0) {
    features_.classes.assign(lines.size(), lidar::FeatureClass::kNone);
  }

  Features pick() && {
    for (std::size_t k = 0; k < lines_.line_count(); ++k) {
      pick_line(lines_.line_begin[k], lines_.line_begin[k + 1]);
    }
    for (const lidar::FeatureClass c : features_.classes) {
      ++features_.counts[static_cast<std::size_t>(c)];
    }
    return std::move(features_);
  }

 private:
  void pick_line(std::size_t begin, std::size_t end) {
    if (end - begin <= 2 * kCurvatureReach) return;
    block_unreliable(begin, end);
    // Every point with a curvature belongs to exactly one sector.
    const std::size_t first = begin + kCurvatureReach;
    const std::size_t count = end - begin - 2 * kCurvatureReach;
    const auto sectors = static_cast<std::size_t>(options_.sectors);
    for (std::size_t s = 0; s < sectors; ++s) {
      pick_sector(first + count * s / sectors, first + count * (s + 1) / sectors);
    }
  }

  void pick_sector(std::size_t begin, std::size_t end) {
    pick_edges(begin, end);
    pick_planes(begin, end);
  }

  /// LOAM figure 4: (b) the far side of a depth jump, (a) a surface nearly along the beam.
  void block_unreliable(std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i + 1 < end; ++i) {
      const float near_range = std::min(lines_.range[i], lines_.range[i + 1]);
      const float step = step_[i];
      const auto reach = static_cast<float>(options_.break_m + options_.break_per_m * near_range);
      if (step <= reach) continue;
      breaks_after_[i] = 1;
      // Not occluded when the two are apart sideways only: a gap in the returns, not in depth.
      if (std::abs(lines_.range[i] - lines_.range[i + 1]) <= 0.5F * step) continue;
      if (lines_.range[i] > lines_.range[i + 1]) {
        block(i - std::min(kSuppressedNeighbours, i - begin), i + 1);
      } else {
        block(i + 1, std::min(end, i + 2 + kSuppressedNeighbours));
      }
    }
    for (std::size_t i = begin + 1; i + 1 < end; ++i) {
      const auto grazing = static_cast<float>(options_.grazing_step_per_m) * lines_.range[i];
      if (step_[i - 1] > grazing && step_[i] > grazing) blocked_[i] = 1;
    }
  }

  void pick_edges(std::size_t begin, std::size_t end) {
    candidates_.clear();
    for (std::size_t i = begin; i < end; ++i) {
      const bool edge = curvature_[i] >= options_.edge_curvature && !is_noise(i);
      if (edge && blocked_[i] == 0) {
        candidates_.push_back(static_cast<std::uint32_t>(i));
      }
    }
    std::sort(candidates_.begin(), candidates_.end(), [&](std::uint32_t a, std::uint32_t b) {
      return curvature_[a] != curvature_[b] ? curvature_[a] > curvature_[b] : a < b;
    });
    int picked = 0;
    for (const std::uint32_t i : candidates_) {
      if (picked == options_.less_sharp_per_sector) break;
      if (blocked_[i] != 0) continue;
      const bool sharp = picked < options_.sharp_per_sector;
      features_.classes[i] = sharp ? lidar::FeatureClass::kSharp : lidar::FeatureClass::kLessSharp;
      ++picked;
      suppress_around(i, blocked_);
    }
  }

  void pick_planes(std::size_t begin, std::size_t end) {
    candidates_.clear();
    for (std::size_t i = begin; i < end; ++i) {
      const bool planar = curvature_[i] <= options_.planar_curvature || is_noise(i);
      if (planar && blocked_[i] == 0) {
        candidates_.push_back(static_cast<std::uint32_t>(i));
      }
    }
    // Each pick suppresses at most ten others, so the flattest are among this many.
    const std::size_t enough =
        std::min(candidates_.size(), static_cast<std::size_t>(options_.flat_per_sector) *
                                         (2 * kSuppressedNeighbours + 1));
    std::partial_sort(
        candidates_.begin(), candidates_.begin() + static_cast<std::ptrdiff_t>(enough),
        candidates_.end(), [&](std::uint32_t a, std::uint32_t b) {
          return curvature_[a] != curvature_[b] ? curvature_[a] < curvature_[b] : a < b;
        });
    int picked = 0;
    for (std::size_t c = 0; c < enough && picked < options_.flat_per_sector; ++c) {
      const std::uint32_t i = candidates_[c];
      if (beside_flat_[i] != 0) continue;
      features_.classes[i] = lidar::FeatureClass::kFlat;
      ++picked;
      suppress_around(i, beside_flat_);
    }
    for (const std::uint32_t i : candidates_) {
      if (features_.classes[i] == lidar::FeatureClass::kNone) {
        features_.classes[i] = lidar::FeatureClass::kLessFlat;
      }
    }
  }

  /// Keeps the picks apart, but not across a break: the next surface has its own features.
  void suppress_around(std::size_t i, std::vector<std::uint8_t>& suppressed) {
    suppressed[i] = 1;
    for (std::size_t j = i; j > i - kSuppressedNeighbours && breaks_after_[j - 1] == 0; --j) {
      suppressed[j - 1] = 1;
    }
    for (std::size_t j = i; j < i + kSuppressedNeighbours && breaks_after_[j] == 0; ++j) {
      suppressed[j + 1] = 1;
    }
  }

  bool is_noise(std::size_t i) const {
    return curvature_[i] * lines_.range[i] <= static_cast<float>(options_.noise_m);
  }

  void block(std::size_t begin, std::size_t end) {
    std::fill(blocked_.begin() + static_cast<std::ptrdiff_t>(begin),
              blocked_.begin() + static_cast<std::ptrdiff_t>(end), std::uint8_t{1});
  }

  const lidar::ScanLines& lines_;
  const FeatureOptions& options_;
  std::vector<float> curvature_;
  std::vector<float> step_;
  std::vector<std::uint8_t> blocked_;       // 1: no feature: unreliable, or beside an edge
  std::vector<std::uint8_t> beside_flat_;   // 1: not another flat point, but a less flat one
  std::vector<std::uint8_t> breaks_after_;  // 1: the surface ends between this point and the next
  std::vector<std::uint32_t> candidates_;
  Features features_;
};

}  // namespace

void bind(config::Binder& b, FeatureOptions& o) {
  using config::Range;
  b.integer("sectors", o.sectors, Range::between(1, 64), "sectors per scan line");
  b.integer("sharp_per_sector", o.sharp_per_sector, Range::non_negative(),
            "edge points of largest curvature");
  b.integer("less_sharp_per_sector", o.less_sharp_per_sector, Range::non_negative(),
            "edge points per sector, sharp ones included");
  b.integer("flat_per_sector", o.flat_per_sector, Range::non_negative(),
            "planar points of smallest curvature");
  b.number("edge_curvature", o.edge_curvature, Range::non_negative(),
           "smallest curvature of an edge point");
  b.number("planar_curvature", o.planar_curvature, Range::non_negative(),
           "largest curvature of a planar point");
  b.number("noise_m", o.noise_m, Range::non_negative(),
           "curvature times range below this is taken for noise");
  b.number("break_m", o.break_m, Range::non_negative(),
           "range step that ends a surface, constant part");
  b.number("break_per_m", o.break_per_m, Range::non_negative(),
           "range step that ends a surface, per metre of range");
  b.number("grazing_step_per_m", o.grazing_step_per_m, Range::positive(),
           "range steps on both sides above this, per metre of range, mark a grazing beam");
}

Features extract_features(const lidar::ScanLines& lines, const FeatureOptions& options) {
  return Picker(lines, options).pick();
}

}  // namespace traverse::loam
