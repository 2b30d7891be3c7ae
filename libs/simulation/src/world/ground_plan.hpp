#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "street.hpp"

namespace traverse::simulation {

/// Which parts of the ground are road and which are built on: a grid of half a metre.
class GroundPlan {
 public:
  GroundPlan(const Eigen::Vector2d& least, const Eigen::Vector2d& most);

  /// Marks the road of a street; `number` tells streets apart, below 32.
  void add_road(const Street& street, double half_width, unsigned number);
  /// The point is on a road other than `number`.
  bool is_other_road(const Eigen::Vector2d& p, unsigned number) const;
  bool is_road(const Eigen::Vector2d& p) const;

  /// Nothing stands on the rectangle about `centre` and no road crosses it.
  bool is_free(const Eigen::Vector2d& centre, double heading, const Eigen::Vector2d& size) const;
  void take(const Eigen::Vector2d& centre, double heading, const Eigen::Vector2d& size);

  const Eigen::Vector2d& least() const { return least_; }
  const Eigen::Vector2d& most() const { return most_; }

 private:
  /// Index of the cell that holds `p`; the last cell for points outside.
  std::size_t cell(const Eigen::Vector2d& p) const;
  template <typename Visit>
  void for_each_in(const Eigen::Vector2d& centre, double heading, const Eigen::Vector2d& size,
                   const Visit& visit) const;

  Eigen::Vector2d least_, most_;
  std::size_t columns_, rows_;
  std::vector<std::uint32_t> roads_;
  std::vector<bool> taken_;
};

}  // namespace traverse::simulation
