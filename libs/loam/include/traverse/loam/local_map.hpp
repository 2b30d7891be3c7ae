#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace traverse::loam {

/// The points of recent scans near the vehicle, one a voxel: the mean of all points that fell into
/// it. Voxels are anchored to the map frame, so that points do not creep as maps that average
/// again and again do. Memory is bounded by the radius.
class LocalMap {
 public:
  /// \param voxel_m edge of a voxel, metres  \param radius_m voxels farther away may be dropped
  LocalMap(double voxel_m, double radius_m);
  LocalMap(const LocalMap& other);  ///< without the search index
  LocalMap& operator=(const LocalMap& other);
  LocalMap(LocalMap&&) noexcept;
  LocalMap& operator=(LocalMap&&) noexcept;
  ~LocalMap();

  void insert(std::span<const Eigen::Vector3d> points_map);

  /// Drops voxels beyond the radius around `centre_map`, but only when the centre has moved a
  /// tenth of the radius since the last time, so that the work is rare.
  void follow(const Eigen::Vector3d& centre_map);

  std::size_t size() const { return points_.size(); }
  std::size_t bytes() const;  ///< of memory that a copy takes, about
  std::span<const Eigen::Vector3d> points() const { return points_; }

  /// Builds the search index over the present points; insert() and follow() drop it.
  void build_index();
  bool has_index() const;

  /// Up to indices.size() nearest points within `radius_m` of `query_map`, nearest first, from the
  /// index of the last build_index(). \returns how many were found.
  std::size_t nearest(const Eigen::Vector3d& query_map, double radius_m,
                      std::span<std::uint32_t> indices) const;

 private:
  struct Grid;
  struct Index;

  double voxel_m_;
  double radius_m_;
  Eigen::Vector3d last_centre_ = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> points_;  // mean of each voxel
  std::vector<std::uint32_t> counts_;    // points behind each mean
  std::vector<std::uint64_t> keys_;      // voxel of each mean
  std::unique_ptr<Grid> grid_;
  std::unique_ptr<Index> index_;
};

}  // namespace traverse::loam
