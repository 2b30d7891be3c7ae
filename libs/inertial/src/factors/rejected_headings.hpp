#pragma once

#include <deque>
#include <optional>

#include "traverse/geometry/stamp.hpp"

namespace traverse::inertial {

/// What headings say together of an estimate that rejects most of them. Each stands as predicted
/// less measured: those that are right agree with each other, as the gyro turned in between, and
/// are all off by as much as the estimate is; those that are wrong scatter.
class RejectedHeadings {
 public:
  /// \param residual  predicted less measured [rad] \param sigma  of the heading [rad]
  void add(geometry::Stamp stamp, double residual, double sigma, bool is_rejected);
  void clear() { headings_.clear(); }

  /// By how much more than half of the headings of the last `seconds` say that the estimate is off,
  /// predicted less measured [rad], where more than half were rejected. Nothing before there are
  /// headings of so long.
  std::optional<double> offset(double seconds) const;

 private:
  struct Heading {
    geometry::Stamp stamp;
    double residual;
    double sigma;
    bool is_rejected;
  };
  std::deque<Heading> headings_;
};

}  // namespace traverse::inertial
