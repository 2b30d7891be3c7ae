#pragma once

#include <vector>

#include <Eigen/Core>

namespace traverse::simulation {

/// Straight legs from point to point with an arc of given radius in place of each corner.
class RoundedLine {
 public:
  /// \throws ImpossibleRoute if two points are the same or an arc does not fit between its legs.
  RoundedLine(const std::vector<Eigen::Vector2d>& points, bool closed, double radius);

  double length() const { return length_; }
  /// The point at distance `s` from the start.
  Eigen::Vector2d at(double s) const;

 private:
  /// A leg, or an arc that turns by `curvature`.
  struct Piece {
    double begin, length;
    Eigen::Vector2d start, direction;
    double curvature;
  };
  void add(const Eigen::Vector2d& start, const Eigen::Vector2d& direction, double length,
           double curvature);

  std::vector<Piece> pieces_;
  double length_ = 0;
};

}  // namespace traverse::simulation
