#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace traverse::plausibility {

/// By what factor one stream tells more than another, over many pieces of a recording.
class Ratio {
 public:
  struct Result {
    double value = 0;           ///< weighted median of y / x
    double spread = 0;          ///< weighted median of |y / x - value|, as a share of |value|
    double sum = 0;             ///< of |x|
    double negative_share = 0;  ///< of the weight: pairs of which one is the other's opposite
    std::size_t pairs = 0;

    /// One factor explains the pairs: half of them are within 30 % of it.
    bool is_consistent() const { return spread < 0.3; }
    /// The factor is `factor` rather than one 1.5 times as large or small.
    bool is_near(double factor) const { return value / factor > 1 / 1.5 && value / factor < 1.5; }
  };

  /// What is taken for right, and what is held against it; weighs as much as it is large.
  void add(double x, double y);

  /// Nothing with fewer pairs or a smaller sum of |x|: too little moved to tell.
  std::optional<Result> find(std::size_t min_pairs, double min_sum) const;

 private:
  struct Pair {
    double ratio;
    double weight;
  };
  static double weighted_median(std::vector<Pair> pairs, double weight);

  std::vector<Pair> pairs_;
};

}  // namespace traverse::plausibility
