#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include <Eigen/Core>

#include "traverse/loam/sweep_features.hpp"

namespace traverse::loam {

/// Points of one scan, searched by place and scan line. A point is named by its number. Copies
/// share the points, which never change.
class LineIndex {
 public:
  LineIndex();  ///< of no points: nothing is ever found
  explicit LineIndex(LinedPoints points);

  std::size_t size() const;
  Eigen::Vector3d point(std::uint32_t i) const;

  /// The point nearest to `query` on any line, nearer than `radius_m`.
  std::optional<std::uint32_t> nearest(const Eigen::Vector3d& query, double radius_m) const;

  /// The nearest one on the line of point `i`, which is at least `apart_m` away from `i`.
  std::optional<std::uint32_t> nearest_along_line(const Eigen::Vector3d& query, double radius_m,
                                                  std::uint32_t i, double apart_m) const;

  /// The nearest one on another line than point `i`, up to `lines` lines above or below it.
  std::optional<std::uint32_t> nearest_across_lines(const Eigen::Vector3d& query, double radius_m,
                                                    std::uint32_t i, int lines) const;

 private:
  struct Search;
  std::shared_ptr<const Search> search_;
};

}  // namespace traverse::loam
