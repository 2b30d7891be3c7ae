#include "recording/lidar_clock.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "traverse/geometry/voxel.hpp"
#include "traverse/statistics/quantile.hpp"

namespace traverse::dataset {

using geometry::Pose3;
using geometry::Twist;

namespace {

constexpr double kNanosecond = 1e-9;
constexpr std::size_t kSurfacePoints = 16'000;  ///< at most, of the first sweep
constexpr std::size_t kMatchedPoints = 4'000;   ///< at most, of each of the others
constexpr double kNoise_m = 0.02;               ///< of a return off a surface
constexpr std::size_t kLeastMatches = 300;      ///< of the other lidar
constexpr double kLeastTold_s = 0.002;          ///< a standard error above tells nothing
constexpr double kMostLate_s = 0.2;

/// Returns at a fixed step, with seconds after the middle of both sweeps.
struct ThinnedReturns {
  std::vector<Eigen::Vector3d> p_lidar;
  std::vector<double> t;
};

ThinnedReturns thinned(const LidarReturns& returns, std::size_t most, std::int64_t middle_ns) {
  ThinnedReturns thin;
  const std::size_t step = returns.size() / most + 1;
  for (std::size_t i = 0; i < returns.size(); i += step) {
    thin.p_lidar.emplace_back(returns.x[i], returns.y[i], returns.z[i]);
    thin.t.push_back(static_cast<double>(returns.ns[i] - middle_ns) * kNanosecond);
  }
  return thin;
}

/// Where a vehicle of constant motion is, by a table of poses that is exact to a millisecond's
/// change of velocity.
class MotionTable {
 public:
  MotionTable(const Twist& motion, double first_s, double last_s)
      : motion_(motion), first_s_(first_s) {
    const auto count = static_cast<std::size_t>((last_s - first_s) / kStep_s) + 2;
    poses_.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      poses_.push_back(geometry::exp_se3(motion * (first_s + kStep_s * static_cast<double>(i))));
    }
  }
  Eigen::Vector3d moved(const Eigen::Vector3d& p_lidar, double t) const {
    const double at = std::max(0.0, (t - first_s_) / kStep_s);
    const std::size_t i = std::min(static_cast<std::size_t>(at), poses_.size() - 1);
    const double rest_s = t - first_s_ - kStep_s * static_cast<double>(i);
    const Eigen::Vector3d velocity = motion_.tail<3>() + motion_.head<3>().cross(p_lidar);
    return poses_[i] * (p_lidar + rest_s * velocity);
  }

 private:
  static constexpr double kStep_s = 1e-3;
  Twist motion_;
  double first_s_;
  std::vector<Pose3> poses_;
};

/// A piece of a surface and when it was seen.
struct Facet {
  Eigen::Vector3d mean;
  Eigen::Vector3d normal;
  double t;
};

struct FacetSums {
  std::size_t count = 0;
  double t = 0;
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Matrix3d pp = Eigen::Matrix3d::Zero();
};

using Facets = std::unordered_map<std::uint64_t, Facet, geometry::VoxelHash>;

/// The flat cells among those that the returns fall into.
Facets facets_of(const ThinnedReturns& returns, const MotionTable& motion, double edge_m) {
  std::unordered_map<std::uint64_t, FacetSums, geometry::VoxelHash> cells;
  for (std::size_t i = 0; i < returns.t.size(); ++i) {
    const Eigen::Vector3d p = motion.moved(returns.p_lidar[i], returns.t[i]);
    FacetSums& cell = cells[geometry::voxel_key(p, edge_m)];
    ++cell.count;
    cell.t += returns.t[i];
    cell.p += p;
    cell.pp += p * p.transpose();
  }
  constexpr std::size_t kLeast = 8;
  constexpr double kWide = 0.15;      // of the edge: the second axis
  constexpr double kFlat = 1.0 / 25;  // of the second axis' variance: the third's
  Facets facets;
  for (const auto& [key, cell] : cells) {
    if (cell.count < kLeast) continue;
    const double n = static_cast<double>(cell.count);
    const Eigen::Vector3d mean = cell.p / n;
    const Eigen::Matrix3d covariance = cell.pp / n - mean * mean.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance);
    const Eigen::Vector3d& variances = axes.eigenvalues();
    const bool is_wide = variances[1] > kWide * kWide * edge_m * edge_m;
    if (!is_wide || variances[0] > kFlat * variances[1]) continue;
    facets.emplace(key, Facet{mean, axes.eigenvectors().col(0), cell.t / n});
  }
  return facets;
}

constexpr int kUnknowns = 7;  ///< motion, lateness
using Normals = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;

struct NormalEquations {
  Normals H = Normals::Zero();
  Unknowns g = Unknowns::Zero();
  std::size_t matches = 0;
  std::size_t matches_of_other = 0;
};

struct Gates {
  double edge_m;
  double gate_m;
  int iterations;
};

/// Adds what the returns say. \param is_other of the lidar whose stamps are late by `late_s`
void accumulate(const ThinnedReturns& returns, const Facets& facets, const MotionTable& table,
                const Twist& motion, const Gates& gates, bool is_other, double late_s,
                NormalEquations& sums) {
  for (std::size_t i = 0; i < returns.t.size(); ++i) {
    const double t = returns.t[i] - (is_other ? late_s : 0);
    const Eigen::Vector3d q = table.moved(returns.p_lidar[i], t);
    const auto found = facets.find(geometry::voxel_key(q, gates.edge_m));
    if (found == facets.end()) continue;
    const Facet& facet = found->second;
    const double r = facet.normal.dot(q - facet.mean);
    if (std::abs(r) > gates.gate_m) continue;
    const double scaled = 3 * r / gates.gate_m;
    const double weight = 1 / (1 + scaled * scaled);
    Unknowns row;
    row.head<3>() = (t - facet.t) * q.cross(facet.normal);
    row.segment<3>(3) = (t - facet.t) * facet.normal;
    const Eigen::Vector3d velocity = motion.tail<3>() + motion.head<3>().cross(q);
    row[6] = is_other ? -facet.normal.dot(velocity) : 0;
    sums.H += weight * row * row.transpose();
    sums.g += weight * r * row;
    ++sums.matches;
    if (is_other) ++sums.matches_of_other;
  }
}

struct SweepPair {
  ThinnedReturns sweep, next, other;
};

struct Fit {
  Twist motion = Twist::Zero();
  double late_s = 0;
  double sigma_s = 0;
  std::size_t matches = 0;
  std::size_t matches_of_other = 0;
  bool is_good = false;
};

constexpr Gates kCoarse{4, 2, 4};
constexpr std::array<Gates, 3> kFiner{{{2, 0.8, 4}, {1, 0.3, 4}, {1, 0.12, 4}}};

void improve(const SweepPair& pair, const Gates& gates, Fit& result) {
  constexpr double kMargin_s = 0.3;
  for (int i = 0; i < gates.iterations; ++i) {
    const MotionTable table(result.motion, pair.sweep.t.front() - kMargin_s,
                            pair.next.t.back() + kMargin_s);
    const Facets facets = facets_of(pair.sweep, table, gates.edge_m);
    NormalEquations sums;
    accumulate(pair.next, facets, table, result.motion, gates, false, 0, sums);
    accumulate(pair.other, facets, table, result.motion, gates, true, result.late_s, sums);
    Normals damped = sums.H;  // so that what nothing tells stays
    damped.diagonal().array() += 1e-3;
    const Unknowns step = -damped.ldlt().solve(sums.g);
    result.is_good = step.allFinite();
    if (!result.is_good) return;
    result.motion += step.head<6>();
    result.late_s = std::clamp(result.late_s + step[6], -kMostLate_s, kMostLate_s);
    result.matches = sums.matches;
    result.matches_of_other = sums.matches_of_other;
    const Eigen::Matrix<double, 6, 1> coupled = sums.H.block<6, 1>(0, 6);
    const Eigen::Matrix<double, 6, 6> of_motion = damped.block<6, 6>(0, 0);
    const double information = sums.H(6, 6) - coupled.dot(of_motion.ldlt().solve(coupled));
    result.sigma_s = information > 0 ? kNoise_m / std::sqrt(information) : kMostLate_s;
  }
}

/// The fit at a coarse look from the speed at which most returns lie on surfaces.
Fit coarse_fit(const SweepPair& pair, const Eigen::Vector3d& ahead) {
  Fit best;
  for (const double speed : {0.0, 4.0, 8.0, 12.0, 16.0, 20.0, 25.0, 30.0, -4.0}) {
    Fit found;
    found.motion.tail<3>() = speed * ahead;
    improve(pair, kCoarse, found);
    improve(pair, kFiner.front(), found);
    if (found.is_good && found.matches > best.matches) best = found;
  }
  return best;
}

}  // namespace

void LidarClock::add(const LidarReturns& sweep, const LidarReturns& next,
                     const LidarReturns& other) {
  if (sweep.size() == 0 || next.size() == 0 || other.size() == 0) return;
  const std::int64_t middle_ns = *std::min_element(next.ns.begin(), next.ns.end());
  const SweepPair pair{thinned(sweep, kSurfacePoints, middle_ns),
                       thinned(next, kMatchedPoints, middle_ns),
                       thinned(other, kMatchedPoints, middle_ns)};
  Fit best;
  if (motion_) {
    best.motion = *motion_;
  } else {
    best = coarse_fit(pair, ahead_first_);
  }
  if (!told_.empty()) best.late_s = told_.back().late_s;
  for (const Gates& gates : kFiner) improve(pair, gates, best);
  const bool is_told =
      best.is_good && best.matches_of_other >= kLeastMatches && std::abs(best.late_s) < kMostLate_s;
  if (!is_told) {
    motion_.reset();
    return;
  }
  motion_ = best.motion;
  if (best.sigma_s < kLeastTold_s) told_.push_back({best.late_s, best.sigma_s});
}

std::optional<Lateness> LidarClock::lateness() const {
  constexpr std::size_t kLeast = 5;
  constexpr double kFar = 4;  // median deviations
  if (told_.size() < kLeast) return std::nullopt;
  std::vector<double> values;
  for (const OfSweep& one : told_) values.push_back(one.late_s);
  const double middle = statistics::median(values);
  std::vector<double> deviations;
  for (const double value : values) deviations.push_back(std::abs(value - middle));
  const double spread = std::max(statistics::median(deviations), 1e-5);
  double weights = 0;
  double sum = 0;
  double squares = 0;
  std::size_t count = 0;
  for (const OfSweep& one : told_) {
    if (std::abs(one.late_s - middle) > kFar * spread) continue;
    const double weight = 1 / (one.sigma_s * one.sigma_s + spread * spread);
    weights += weight;
    sum += weight * one.late_s;
    squares += weight * (one.late_s - middle) * (one.late_s - middle);
    ++count;
  }
  const double mean = sum / weights;
  const double variance = std::max(squares / weights - (mean - middle) * (mean - middle), 0.0);
  return Lateness{mean, std::sqrt(variance / static_cast<double>(count)), told_.size()};
}

bool LidarClock::is_known() const {
  constexpr std::size_t kEnough = 20;
  constexpr std::size_t kMost = 60;
  constexpr double kFine_s = 1e-4;
  if (told_.size() >= kMost) return true;
  const auto found = told_.size() >= kEnough ? lateness() : std::nullopt;
  return found && found->sigma_s < kFine_s;
}

}  // namespace traverse::dataset
