#include "traverse/loam/line_index.hpp"

#include <cstdlib>
#include <utility>

#include <nanoflann.hpp>

#include "traverse/geometry/kd_tree_points.hpp"

namespace traverse::loam {

namespace {

constexpr std::size_t kSweepLeafSize = 20;

/// The points of a sweep, whose axes are stored one after the other.
struct SweepAxes {
  const lidar::TimedPoints& points;

  std::size_t size() const { return points.size(); }
  double coordinate(std::size_t i, std::size_t axis) const {
    return double{axis == 0 ? points.x[i] : axis == 1 ? points.y[i] : points.z[i]};
  }
};

using SweepPointSet = geometry::KdTreePoints<SweepAxes>;
using SweepTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, SweepPointSet>,
                                        SweepPointSet, 3, std::uint32_t>;

/// nanoflann's collector of results: the nearest point that `Accept` takes.
template <typename Accept>
class NearestAccepted {
 public:
  NearestAccepted(double radius_m, const Accept& accept)
      : accept_(accept), squared_distance_(radius_m * radius_m) {}

  bool addPoint(double squared_distance, std::uint32_t i) {
    if (squared_distance < squared_distance_ && accept_(i)) {
      squared_distance_ = squared_distance;
      nearest_ = i;
    }
    return true;  // go on searching
  }
  double worstDist() const { return squared_distance_; }
  bool full() const { return true; }
  std::optional<std::uint32_t> nearest() const { return nearest_; }

 private:
  const Accept& accept_;
  double squared_distance_;
  std::optional<std::uint32_t> nearest_;
};

}  // namespace

struct LineIndex::Search {
  explicit Search(LinedPoints those)
      : points(std::move(those)),
        set{{points.points}},
        tree(3, set, nanoflann::KDTreeSingleIndexAdaptorParams(kSweepLeafSize)) {}

  int line(std::uint32_t i) const { return points.line[i]; }

  template <typename Accept>
  std::optional<std::uint32_t> nearest(const Eigen::Vector3d& query, double radius_m,
                                       const Accept& accept) const {
    if (points.size() == 0) return std::nullopt;
    NearestAccepted<Accept> found(radius_m, accept);
    tree.findNeighbors(found, query.data(), nanoflann::SearchParams());
    return found.nearest();
  }

  LinedPoints points;
  SweepPointSet set;
  SweepTree tree;
};

LineIndex::LineIndex() : LineIndex(LinedPoints{}) {}
LineIndex::LineIndex(LinedPoints points)
    : search_(std::make_shared<const Search>(std::move(points))) {}

std::size_t LineIndex::size() const { return search_->points.size(); }

Eigen::Vector3d LineIndex::point(std::uint32_t i) const { return search_->points.points.point(i); }

std::optional<std::uint32_t> LineIndex::nearest(const Eigen::Vector3d& query,
                                                double radius_m) const {
  return search_->nearest(query, radius_m, [](std::uint32_t) { return true; });
}

std::optional<std::uint32_t> LineIndex::nearest_along_line(const Eigen::Vector3d& query,
                                                           double radius_m, std::uint32_t i,
                                                           double apart_m) const {
  const Eigen::Vector3d p = point(i);
  return search_->nearest(query, radius_m, [&](std::uint32_t k) {
    return search_->line(k) == search_->line(i) && (point(k) - p).norm() >= apart_m && k != i;
  });
}

std::optional<std::uint32_t> LineIndex::nearest_across_lines(const Eigen::Vector3d& query,
                                                             double radius_m, std::uint32_t i,
                                                             int lines) const {
  return search_->nearest(query, radius_m, [&](std::uint32_t k) {
    const int apart = std::abs(search_->line(k) - search_->line(i));
    return apart != 0 && apart <= lines;
  });
}

}  // namespace traverse::loam
