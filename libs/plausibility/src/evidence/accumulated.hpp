#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace traverse::plausibility {

/// A quantity of N numbers that sums up over time (distance, turn), kept at knots a tenth of a
/// second apart between which it grows evenly. Streams of any rate compare through it: each tells
/// how much there was between two moments. Memory is bounded: what comes after the first hour is
/// left out.
template <int N>
class Accumulated {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;

  /// \param increment from the reading before to that at `t` [s], which grows
  /// \param is_gap nothing is known of the time between
  void add(double t, const Vector& increment, bool is_gap) {
    if (knots_.size() >= kMaxKnots) return;
    if (knots_.empty()) {
      knots_.push_back({t, Vector::Zero(), 0});
      return;
    }
    const Knot& last = knots_.back();
    if (!(t > last.t)) return;
    const Knot next{t, Vector(last.sum + (is_gap ? Vector::Zero() : increment)),
                    last.gaps + (is_gap ? 1U : 0U)};
    const bool replaces = knots_.size() >= 2 && !is_gap &&
                          knots_[knots_.size() - 2].gaps == last.gaps &&
                          last.t - knots_[knots_.size() - 2].t < kSpacing_s;
    if (replaces) knots_.pop_back();
    knots_.push_back(next);
  }

  /// How much there was from t0 to t1; nothing outside the knots or across a gap.
  std::optional<Vector> between(double t0, double t1) const {
    const std::optional<Knot> begin = at(t0);
    const std::optional<Knot> end = at(t1);
    if (!begin || !end || begin->gaps != end->gaps) return std::nullopt;
    return Vector(end->sum - begin->sum);
  }

  bool empty() const { return knots_.size() < 2; }
  double begin_s() const { return knots_.front().t; }
  double end_s() const { return knots_.back().t; }

  /// Calls `use` with begin, end and the amount of each piece between knots that is not a gap.
  template <typename Use>
  void for_each_piece(const Use& use) const {
    for (std::size_t i = 1; i < knots_.size(); ++i) {
      if (knots_[i].gaps != knots_[i - 1].gaps) continue;
      use(knots_[i - 1].t, knots_[i].t, Vector(knots_[i].sum - knots_[i - 1].sum));
    }
  }

 private:
  static constexpr double kSpacing_s = 0.1;
  static constexpr std::size_t kMaxKnots = 36'000;

  struct Knot {
    double t = 0;
    Vector sum;
    std::size_t gaps = 0;  ///< before it
  };

  std::optional<Knot> at(double t) const {
    if (knots_.empty() || !(t >= knots_.front().t && t <= knots_.back().t)) return std::nullopt;
    const auto after =
        std::lower_bound(knots_.begin(), knots_.end(), t,
                         [](const Knot& knot, double time) { return knot.t < time; });
    if (after == knots_.begin() || after->t == t) return *after;
    const Knot& before = *std::prev(after);
    if (before.gaps != after->gaps) return std::nullopt;
    const double share = (t - before.t) / (after->t - before.t);
    return Knot{t, Vector(before.sum + share * (after->sum - before.sum)), before.gaps};
  }

  std::vector<Knot> knots_;
};

}  // namespace traverse::plausibility
