#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace traverse::slam {

/// A position as an index of three dimensions takes it.
std::array<float, 3> as_place(const Eigen::Vector3d& p);

/// Points of a space of few dimensions, found by nearness: ring keys of scans, positions of
/// keyframes. A forest of k-d trees whose sizes are powers of two (nanoflann's dynamic index;
/// Bentley and Saxe's logarithmic method), so that both adding and finding stay logarithmic on the
/// mean.
class PlaceIndex {
 public:
  explicit PlaceIndex(std::size_t dimensions);
  PlaceIndex(const PlaceIndex& other);
  PlaceIndex& operator=(const PlaceIndex& other);
  PlaceIndex(PlaceIndex&&) noexcept;
  PlaceIndex& operator=(PlaceIndex&&) noexcept;
  ~PlaceIndex();

  /// One place or several, one after the other; many at once cost less than one by one. The number
  /// of the first is the size before. \throws std::invalid_argument for another number of
  /// dimensions
  void add(std::span<const float> places);

  std::size_t size() const;

  struct Found {
    std::size_t number = 0;
    double distance = 0;
  };
  /// Up to `most` places, nearest first; of equally near ones the earlier first.
  std::vector<Found> nearest(std::span<const float> place, std::size_t most) const;
  /// All places nearer than `radius`, in the same order.
  std::vector<Found> within(std::span<const float> place, double radius) const;

 private:
  struct Forest;
  std::size_t dimensions_;
  std::unique_ptr<Forest> forest_;
};

}  // namespace traverse::slam
