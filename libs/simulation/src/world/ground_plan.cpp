#include "ground_plan.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace traverse::simulation {

namespace {

constexpr double kCell = 0.5;

}  // namespace

GroundPlan::GroundPlan(const Eigen::Vector2d& least, const Eigen::Vector2d& most)
    : least_(least),
      most_(most),
      columns_(static_cast<std::size_t>((most.x() - least.x()) / kCell) + 1),
      rows_(static_cast<std::size_t>((most.y() - least.y()) / kCell) + 1),
      roads_(columns_ * rows_ + 1, 0),
      taken_(columns_ * rows_ + 1, false) {}

std::size_t GroundPlan::cell(const Eigen::Vector2d& p) const {
  const Eigen::Vector2d offset = (p - least_) / kCell;
  if (offset.minCoeff() < 0) return columns_ * rows_;
  const auto column = static_cast<std::size_t>(offset.x());
  const auto row = static_cast<std::size_t>(offset.y());
  return column < columns_ && row < rows_ ? row * columns_ + column : columns_ * rows_;
}

template <typename Visit>
void GroundPlan::for_each_in(const Eigen::Vector2d& centre, double heading,
                             const Eigen::Vector2d& size, const Visit& visit) const {
  const Eigen::Rotation2Dd turn(heading);
  const double step = 0.7 * kCell;  // no cell is stepped over
  for (double x = -size.x() / 2; x <= size.x() / 2; x += step) {
    for (double y = -size.y() / 2; y <= size.y() / 2; y += step) {
      visit(cell(centre + turn * Eigen::Vector2d(x, y)));
    }
  }
}

void GroundPlan::add_road(const Street& street, double half_width, unsigned number) {
  for (const auto& station : street.stations) {
    for_each_in(station.point, station.heading, {2, 2 * half_width},
                [&](std::size_t i) { roads_[i] |= 1U << number; });
  }
}

bool GroundPlan::is_other_road(const Eigen::Vector2d& p, unsigned number) const {
  return (roads_[cell(p)] & ~(1U << number)) != 0;
}

bool GroundPlan::is_road(const Eigen::Vector2d& p) const { return roads_[cell(p)] != 0; }

bool GroundPlan::is_free(const Eigen::Vector2d& centre, double heading,
                         const Eigen::Vector2d& size) const {
  bool is_free = true;
  for_each_in(centre, heading, size,
              [&](std::size_t i) { is_free = is_free && roads_[i] == 0 && !taken_[i]; });
  return is_free;
}

void GroundPlan::take(const Eigen::Vector2d& centre, double heading, const Eigen::Vector2d& size) {
  for_each_in(centre, heading, size, [&](std::size_t i) { taken_[i] = true; });
}

}  // namespace traverse::simulation
