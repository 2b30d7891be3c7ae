#include "traverse/evaluation/consistency.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "traverse/evaluation/evaluation_error.hpp"
#include "traverse/geometry/voxel_set.hpp"

#include "consistency_totals.hpp"

namespace traverse::evaluation {

using namespace consistency;

namespace {

constexpr int kBitsOfAxis = 21;
constexpr std::int64_t kMiddleCell = std::int64_t{1} << (kBitsOfAxis - 1);
constexpr double kFarthestFromFirst_m = 5e5;     // keeps every cell within its 21 bits
constexpr double kLargestEntryOfRotation = 1.1;  // with room for rounding: so does this

/// Cells of the map are cubes as wide as a neighbourhood's radius: its points lie in 27 of them.
/// The z index comes last, so that three cells of one column are neighbours in the sorted order.
std::uint64_t packed(const Eigen::Matrix<std::int64_t, 3, 1>& cell) {
  const auto axis = [](std::int64_t index) {
    return static_cast<std::uint64_t>(index + kMiddleCell);
  };
  return axis(cell.x()) << (2 * kBitsOfAxis) | axis(cell.y()) << kBitsOfAxis | axis(cell.z());
}

constexpr std::uint64_t cell_step(int dx, int dy) {
  return (static_cast<std::uint64_t>(dx) << (2 * kBitsOfAxis)) +
         (static_cast<std::uint64_t>(dy) << kBitsOfAxis);
}

/// A mixing of all 32 bits (lowbias32 of Wellons).
std::uint32_t hash(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352dU;
  x ^= x >> 15;
  x *= 0x846ca68bU;
  x ^= x >> 16;
  return x;
}

bool is_query(std::uint32_t number) { return hash(number) % kQueryShare == 0; }

bool in_range(const Eigen::Vector3d& p_lidar) {
  const double range_m = p_lidar.norm();  // not a number where a coordinate is none
  return range_m >= kLeastRange_m && range_m <= kMostRange_m;
}

}  // namespace

/// The sorted points with an index to where each cell begins.
class ConsistencyScorer::Grid {
 public:
  Grid(const std::vector<MapPoint>& points, const std::vector<std::uint32_t>& first_number_of_scan)
      : points_(points), first_number_of_scan_(first_number_of_scan) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i == 0 || points[i].cell != points[i - 1].cell) begins_.push_back({points[i].cell, i});
    }
    begins_.push_back({std::numeric_limits<std::uint64_t>::max(), points.size()});
  }

  void score_queries(ConsistencyTotals& totals) {
    for (std::size_t c = 0; c + 1 < begins_.size(); ++c) {
      bool found = false;  // the neighbourhood is one for all queries of the cell
      for (std::size_t i = begins_[c].index; i < begins_[c + 1].index; ++i) {
        if (!is_query(points_[i].number)) continue;
        if (!std::exchange(found, true)) find_neighbourhood(begins_[c].cell);
        score(points_[i], totals);
      }
    }
  }

 private:
  struct Begin {
    std::uint64_t cell;
    std::size_t index;
  };
  /// The points of a cell and where the cell lies from the query's.
  struct Part {
    std::size_t begin, end;
    double x_m, y_m, z_m;
  };

  void find_neighbourhood(std::uint64_t cell) {
    neighbourhood_.clear();
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        const std::uint64_t lowest = cell + cell_step(dx, dy) - 1;
        auto begin = std::lower_bound(
            begins_.begin(), begins_.end() - 1, lowest,
            [](const Begin& entry, std::uint64_t value) { return entry.cell < value; });
        for (; begin->cell <= lowest + 2; ++begin) {
          const auto dz = static_cast<double>(begin->cell - lowest) - 1;
          neighbourhood_.push_back(
              {begin->index, (begin + 1)->index, dx * kRadius_m, dy * kRadius_m, dz * kRadius_m});
        }
      }
    }
  }

  /// Numbers of points from scans fewer than kFewestScansApart away from that of `number`.
  std::pair<std::uint32_t, std::uint32_t> numbers_near(std::uint32_t number) const {
    const auto& firsts = first_number_of_scan_;
    const auto scan = static_cast<std::size_t>(
        std::upper_bound(firsts.begin(), firsts.end(), number) - firsts.begin() - 1);
    const std::size_t begin = scan < kFewestScansApart ? 0 : scan - kFewestScansApart + 1;
    const std::size_t end = scan + kFewestScansApart;
    return {firsts[begin],
            end < firsts.size() ? firsts[end] : std::numeric_limits<std::uint32_t>::max()};
  }

  void score(const MapPoint& query, ConsistencyTotals& totals) const {
    const auto [near_begin, near_end] = numbers_near(query.number);
    Moments all;
    Moments far;
    for (const Part& part : neighbourhood_) {
      const double x0 = part.x_m - double{query.in_cell_m[0]};
      const double y0 = part.y_m - double{query.in_cell_m[1]};
      const double z0 = part.z_m - double{query.in_cell_m[2]};
      for (std::size_t i = part.begin; i < part.end; ++i) {
        const MapPoint& point = points_[i];
        const double x = x0 + double{point.in_cell_m[0]};
        const double y = y0 + double{point.in_cell_m[1]};
        const double z = z0 + double{point.in_cell_m[2]};
        if (x * x + y * y + z * z > kRadius_m * kRadius_m) continue;
        all.add(x, y, z);
        if (point.number < near_begin || point.number >= near_end) far.add(x, y, z);
      }
    }
    totals.add(all, far);
  }

  const std::vector<MapPoint>& points_;
  const std::vector<std::uint32_t>& first_number_of_scan_;
  std::vector<Begin> begins_;
  std::vector<Part> neighbourhood_;
};

ConsistencyScorer::ConsistencyScorer(std::string points_are) : points_are_(std::move(points_are)) {}

void ConsistencyScorer::add(std::span<const float> x, std::span<const float> y,
                            std::span<const float> z, const geometry::Pose3& T_map_lidar) {
  if (x.size() != y.size() || x.size() != z.size()) {
    throw std::invalid_argument("the coordinates of a scan differ in number");
  }
  if (!(T_map_lidar.rotation.array().abs() < kLargestEntryOfRotation).all() ||
      !T_map_lidar.translation.allFinite()) {
    throw std::invalid_argument("the pose of a scan is not finite or not rigid");
  }
  if (first_number_of_scan_.empty()) p_map_origin_ = T_map_lidar.translation;
  if (!((T_map_lidar.translation - p_map_origin_).norm() < kFarthestFromFirst_m)) {
    throw EvaluationError("a scan is more than 500 km from the first: no map to score");
  }
  if (points_.size() + x.size() >= std::numeric_limits<std::uint32_t>::max()) {
    throw EvaluationError("the map has more points than can be scored (4e9)");
  }
  first_number_of_scan_.push_back(static_cast<std::uint32_t>(points_.size()));
  geometry::VoxelSet voxels(consistency::kVoxel_m, x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Eigen::Vector3d p_lidar(x[i], y[i], z[i]);
    if (!in_range(p_lidar) || !voxels.insert(p_lidar)) continue;
    const Eigen::Vector3d p_map = T_map_lidar * p_lidar - p_map_origin_;
    const Eigen::Vector3d cell = (p_map / kRadius_m).array().floor();
    const Eigen::Vector3f in_cell_m = (p_map - cell * kRadius_m).cast<float>();
    points_.push_back({packed(cell.cast<std::int64_t>()),
                       {in_cell_m.x(), in_cell_m.y(), in_cell_m.z()},
                       static_cast<std::uint32_t>(points_.size())});
  }
}

std::optional<Consistency> ConsistencyScorer::score() {
  std::sort(points_.begin(), points_.end(), [](const MapPoint& a, const MapPoint& b) {
    return a.cell != b.cell ? a.cell < b.cell : a.number < b.number;
  });
  ConsistencyTotals totals;
  Grid(points_, first_number_of_scan_).score_queries(totals);
  std::optional<Consistency> result = totals.result();
  if (result) {
    result->scans = first_number_of_scan_.size();
    result->points = points_.size();
    result->points_are = points_are_;
  }
  return result;
}

}  // namespace traverse::evaluation
