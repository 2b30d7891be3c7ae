#pragma once

#include <optional>
#include <vector>

#include "traverse/inertial/navigation.hpp"

namespace traverse::inertial {

/// Which fixes are kept back, and what became of the estimate meanwhile.
class OutageSchedule {
 public:
  explicit OutageSchedule(const OutageOptions& options) : options_(options) {}

  void start(geometry::Stamp stamp);
  /// Whether a fix at `stamp` is kept back.
  bool is_out(geometry::Stamp stamp);
  /// Whether the last fix was kept back.
  bool is_now_out() const { return is_out_; }
  void add_distance(double metres) { distance_m_ += is_out_ ? metres : 0; }

  /// True for the first fix after a spell.
  bool has_just_ended() const { return ended_; }
  OutageResult take_result(double error_m, double sigma_m);

 private:
  OutageOptions options_;
  std::optional<geometry::Stamp> begin_;  ///< of the present or next spell
  std::size_t next_ = 0;
  bool is_out_ = false;
  bool ended_ = false;
  double distance_m_ = 0;
};

}  // namespace traverse::inertial
