#include "comparison/distortion_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "traverse/geometry/so3.hpp"
#include "traverse/geometry/voxel.hpp"
#include "traverse/statistics/quantile.hpp"

namespace traverse::plausibility {

namespace {

constexpr double kCell_m = 1.2;
constexpr double kMaxDistance_m = 0.6;

/// The points of a cell, if they lie on a plane.
struct Plane {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double time = 0;  // mean of the points
  bool is_plane = false;
};

struct CellSum {
  std::uint64_t key = 0;
  std::uint32_t point = 0;
};

/// By sorting the points by cell: the same planes on every machine.
class PlaneGrid {
 public:
  explicit PlaneGrid(const TimedScan& scan) {
    std::vector<CellSum> order;
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      order.push_back({key_of(scan.points[i].cast<double>()), static_cast<std::uint32_t>(i)});
    }
    std::sort(order.begin(), order.end(), [](const CellSum& l, const CellSum& r) {
      return l.key != r.key ? l.key < r.key : l.point < r.point;
    });
    for (std::size_t begin = 0; begin < order.size();) {
      std::size_t end = begin;
      while (end < order.size() && order[end].key == order[begin].key) ++end;
      const Plane plane = plane_of(scan, order, begin, end);
      if (plane.is_plane) {
        keys_.push_back(order[begin].key);
        planes_.push_back(plane);
      }
      begin = end;
    }
  }

  const Plane* find(const Eigen::Vector3d& p) const {
    const std::uint64_t key = key_of(p);
    const auto found = std::lower_bound(keys_.begin(), keys_.end(), key);
    if (found == keys_.end() || *found != key) return nullptr;
    return &planes_[static_cast<std::size_t>(found - keys_.begin())];
  }

 private:
  static std::uint64_t key_of(const Eigen::Vector3d& p) { return geometry::voxel_key(p, kCell_m); }

  static Plane plane_of(const TimedScan& scan, const std::vector<CellSum>& order, std::size_t begin,
                        std::size_t end) {
    constexpr std::size_t kMinPoints = 8;
    constexpr double kMaxThickness_m = 0.08;
    Plane plane;
    const auto count = static_cast<double>(end - begin);
    if (end - begin < kMinPoints) return plane;
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (std::size_t k = begin; k < end; ++k) {
      const Eigen::Vector3d p = scan.points[order[k].point].cast<double>();
      plane.mean += p / count;
      plane.time += static_cast<double>(scan.times[order[k].point]) / count;
    }
    for (std::size_t k = begin; k < end; ++k) {
      const Eigen::Vector3d d = scan.points[order[k].point].cast<double>() - plane.mean;
      sum += d * d.transpose() / count;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(sum);
    const Eigen::Vector3d& l = eigen.eigenvalues();
    // Spread over two directions, or it is a piece of one scan line, whose plane is any.
    plane.is_plane = l[0] < kMaxThickness_m * kMaxThickness_m && l[0] < 0.05 * l[1] &&
                     l[1] > 0.05 * l[2] && l[1] > 0.01;
    plane.normal = eigen.eigenvectors().col(0);
    return plane;
  }

  std::vector<std::uint64_t> keys_;
  std::vector<Plane> planes_;
};

/// What brings a raw point to the stamp, to first order: t (w x p + v).
Eigen::Vector3d motion(const geometry::Twist& velocity, const Eigen::Vector3d& p, double time) {
  return time * (velocity.head<3>().cross(p) + velocity.tail<3>());
}

struct Row {
  Eigen::Matrix<double, 7, 1> slope;
  double residual;
};

std::optional<Distortion> fit_from(const PlaneGrid& planes, const TimedScan& a, const TimedScan& b,
                                   double share) {
  constexpr int kIterations = 12;
  constexpr std::size_t kMinMatches = 150;
  constexpr double kSmallestScale_m = 0.02;  // noise of a range
  constexpr double kOnPlane_m = 0.1;
  geometry::Pose3 T_a_b = a.T_map_lidar.inverse() * b.T_map_lidar;
  Distortion result;
  result.share = share;
  std::vector<Row> rows;
  std::vector<double> sizes;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    rows.clear();
    sizes.clear();
    result.score = 0;
    for (std::size_t i = 0; i < b.points.size(); ++i) {
      const Eigen::Vector3d p_b = b.points[i].cast<double>();
      const Eigen::Vector3d step_b = motion(b.velocity, p_b, b.times[i]);
      const Eigen::Vector3d p_a = T_a_b * (p_b + result.share * step_b);
      const Plane* plane = planes.find(p_a);
      if (plane == nullptr) continue;
      const Eigen::Vector3d step_a = motion(a.velocity, plane->mean, plane->time);
      const Eigen::Vector3d& n = plane->normal;
      const double residual = n.dot(p_a - plane->mean - result.share * step_a);
      if (std::abs(residual) > kMaxDistance_m) continue;
      Row row;
      row.slope << p_a.cross(n), n, n.dot(T_a_b.rotation * step_b - step_a);
      row.residual = residual;
      rows.push_back(row);
      sizes.push_back(std::abs(residual));
      const double off = residual / kOnPlane_m;
      if (std::abs(off) < 1) result.score += (1 - off * off) * (1 - off * off);
    }
    if (rows.size() < kMinMatches) return std::nullopt;
    const double scale =
        std::max(kSmallestScale_m, 1.4826 * statistics::element_at_share(sizes, 0.5));
    const double reach = 4.685 * scale;
    Eigen::Matrix<double, 7, 7> H = Eigen::Matrix<double, 7, 7>::Zero();
    Eigen::Matrix<double, 7, 1> g = Eigen::Matrix<double, 7, 1>::Zero();
    double sum = 0;
    double weights = 0;
    for (const Row& row : rows) {
      const double u = row.residual / reach;
      if (std::abs(u) >= 1) continue;
      const double weight = (1 - u * u) * (1 - u * u);
      H += weight * row.slope * row.slope.transpose();
      g += weight * row.residual * row.slope;
      sum += weight * row.residual * row.residual;
      weights += weight;
    }
    const Eigen::LDLT<Eigen::Matrix<double, 7, 7>> solver(H);
    if (solver.info() != Eigen::Success || !(solver.rcond() > 1e-10)) return std::nullopt;
    const Eigen::Matrix<double, 7, 1> step = -solver.solve(g);
    const Eigen::Matrix3d turn = geometry::exp_so3(step.head<3>());
    T_a_b.rotation = turn * T_a_b.rotation;
    T_a_b.translation = turn * T_a_b.translation + step.segment<3>(3);
    result.share += step[6];
    result.rms_m = std::sqrt(sum / weights);
    // Residuals of one plane have the error of the plane in common: planes count, not points.
    constexpr double kPointsOfAPlane = 8;
    const Eigen::Matrix<double, 7, 1> of_share = solver.solve(Eigen::Matrix<double, 7, 1>::Unit(6));
    result.sigma = std::sqrt(kPointsOfAPlane * of_share[6]) * std::max(result.rms_m, 0.01);
    if (step.head<6>().norm() < 1e-3 && std::abs(step[6]) < 1e-2) break;
  }
  if (!std::isfinite(result.share) || !std::isfinite(result.sigma)) return std::nullopt;
  return result;
}

}  // namespace

std::optional<Distortion> fit_distortion(const TimedScan& a, const TimedScan& b) {
  const PlaneGrid planes(a);
  std::optional<Distortion> best;
  // What is matched wrongly at a wrong share holds it there.
  for (const double share : {0.0, 1.0, -1.0}) {
    const auto fit = fit_from(planes, a, b, share);
    if (fit && (!best || fit->score > best->score)) best = fit;
  }
  return best;
}

}  // namespace traverse::plausibility
