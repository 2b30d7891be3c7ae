#include "traverse/voxel_map/scan_objective.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "traverse/parallel/workers.hpp"

#include "lanes.hpp"

namespace traverse::voxel_map {

namespace {

constexpr std::size_t kBlock = 1024;  // rows; their sums are floats, everything above doubles

// Places in the sums of a block: 21 of H (upper triangle by rows), 6 of g, then
constexpr std::size_t kGradient = 21;
constexpr std::size_t kCost = 27;
constexpr std::size_t kWeight = 28;
constexpr std::size_t kSquared = 29;
constexpr std::size_t kInliers = 30;
constexpr std::size_t kSums = 31;
using Sums = std::array<double, kSums>;

/// The pose and the motion as floats, for loops. Lever arms are from the lidar, in map axes.
struct FloatPose {
  float r[9];
  float t[3];          ///< relative to the origin of the local coordinates
  SweepMotion motion;  ///< a second, lidar frame
  float w[3], v[3];    ///< over the interval, map axes
  float per_interval;  ///< 1 / interval; 0 when the deskew does not follow the pose

  FloatPose(const geometry::Pose3& T_map_lidar, const Eigen::Vector3d& origin_map,
            const MotionModel& model)
      : motion(model.velocity_at(T_map_lidar)) {
    const Eigen::Matrix3d& R = T_map_lidar.rotation;
    const geometry::Twist velocity = model.velocity_at(T_map_lidar);
    const Eigen::Vector3d turned_w = model.interval_s * (R * velocity.head<3>());
    const Eigen::Vector3d turned_v = model.interval_s * (R * velocity.tail<3>());
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) r[3 * i + j] = static_cast<float>(R(i, j));
      t[i] = static_cast<float>(T_map_lidar.translation[i] - origin_map[i]);
      w[i] = static_cast<float>(turned_w[i]);
      v[i] = static_cast<float>(turned_v[i]);
    }
    per_interval = model.deskew ? static_cast<float>(1 / model.interval_s) : 0;
  }
};

/// Points at a pose: lever arms m from the lidar, in map axes, and shares s of the interval.
struct MovedPoints {
  Lanes mx, my, mz, s;
};

/// One row of each of these points.
struct Rows {
  Lanes nx, ny, nz;
  Lanes r;       ///< residual, metres
  Lanes weight;  ///< zero beyond the last row
  Lanes e2;      ///< squared residual over its variance
};

[[gnu::always_inline]] inline void move(const PlaneRows& rows, std::size_t i, const FloatPose& pose,
                                        MovedPoints& points) {
  Lanes x;
  Lanes y;
  Lanes z;
  Lanes time;
  load(rows.x, i, x);
  load(rows.y, i, y);
  load(rows.z, i, z);
  load(rows.time, i, time);
  pose.motion.apply(time, x, y, z);
  points.mx = pose.r[0] * x + pose.r[1] * y + pose.r[2] * z;
  points.my = pose.r[3] * x + pose.r[4] * y + pose.r[5] * z;
  points.mz = pose.r[6] * x + pose.r[7] * y + pose.r[8] * z;
  points.s = time * pose.per_interval;
}

[[gnu::always_inline]] inline void measure(const PlaneRows& from, std::size_t i,
                                           const MovedPoints& points, const FloatPose& pose,
                                           Rows& rows) {
  Lanes d;
  load(from.nx, i, rows.nx);
  load(from.ny, i, rows.ny);
  load(from.nz, i, rows.nz);
  load(from.d, i, d);
  load(from.weight, i, rows.weight);
  rows.r = rows.nx * (points.mx + pose.t[0]) + rows.ny * (points.my + pose.t[1]) +
           rows.nz * (points.mz + pose.t[2]) + d;
  rows.e2 = rows.r * rows.r * rows.weight;
}

/// What a match is worth: `share` of the cost; each of its rows is `unit` of a match.
struct MatchWorth {
  float k2;  ///< squared width of the kernel
  float share;
  float unit;
};

[[gnu::always_inline]] inline void accumulate(const MovedPoints& points, const Rows& rows,
                                              const FloatPose& p, const MatchWorth& worth,
                                              Lanes (&sums)[kSums]) {
  const Lanes u = worth.k2 / (worth.k2 + rows.e2);
  const Lanes w = worth.share * rows.weight * u * u;
  const Lanes counted = rows.weight > 0 ? Lanes{} + worth.unit : Lanes{};
  sums[kCost] += worth.share * counted * rows.e2 * u;
  sums[kWeight] += worth.unit * w;
  sums[kSquared] += rows.r * rows.r;
  sums[kInliers] += rows.e2 <= worth.k2 ? counted : Lanes{};

  const Lanes jx = points.my * rows.nz - points.mz * rows.ny;
  const Lanes jy = points.mz * rows.nx - points.mx * rows.nz;
  const Lanes jz = points.mx * rows.ny - points.my * rows.nx;
  const Lanes f = 1 + points.s;
  const Lanes a = 0.5F * points.s * f;
  const Lanes J[6] = {
      f * jx + a * (jy * p.w[2] - jz * p.w[1] + rows.ny * p.v[2] - rows.nz * p.v[1]),
      f * jy + a * (jz * p.w[0] - jx * p.w[2] + rows.nz * p.v[0] - rows.nx * p.v[2]),
      f * jz + a * (jx * p.w[1] - jy * p.w[0] + rows.nx * p.v[1] - rows.ny * p.v[0]),
      f * rows.nx + a * (rows.ny * p.w[2] - rows.nz * p.w[1]),
      f * rows.ny + a * (rows.nz * p.w[0] - rows.nx * p.w[2]),
      f * rows.nz + a * (rows.nx * p.w[1] - rows.ny * p.w[0])};
  std::size_t k = 0;
  for (std::size_t row = 0; row < 6; ++row) {
    const Lanes wj = w * J[row];
    for (std::size_t col = row; col < 6; ++col) sums[k++] += wj * J[col];
    sums[kGradient + row] += wj * rows.r;
  }
}

/// The sum over the lanes, in order.
void collect(const Lanes (&lanes)[kSums], Sums& sums) {
  for (std::size_t k = 0; k < kSums; ++k) {
    sums[k] = 0;
    for (std::size_t l = 0; l < kLanes; ++l) sums[k] += lanes[k][l];
  }
}

TRAVERSE_AVX2_TOO
void sum_planes(const PlaneRows& planes, std::size_t begin, std::size_t end, const FloatPose& pose,
                const MatchWorth& worth, Sums& sums) {
  Lanes lanes[kSums] = {};
  for (std::size_t i = begin; i < end; i += kLanes) {
    MovedPoints points;
    Rows rows;
    move(planes, i, pose, points);
    measure(planes, i, points, pose, rows);
    accumulate(points, rows, pose, worth, lanes);
  }
  collect(lanes, sums);
}

/// The two rows of a line are of one point and share one weight in the kernel.
TRAVERSE_AVX2_TOO
void sum_lines(const PlaneRows& line_1, const PlaneRows& line_2, std::size_t begin, std::size_t end,
               const FloatPose& pose, const MatchWorth& worth, Sums& sums) {
  Lanes lanes[kSums] = {};
  for (std::size_t i = begin; i < end; i += kLanes) {
    MovedPoints points;
    Rows first;
    Rows second;
    move(line_1, i, pose, points);
    measure(line_1, i, points, pose, first);
    measure(line_2, i, points, pose, second);
    first.e2 += second.e2;
    second.e2 = first.e2;
    accumulate(points, first, pose, worth, lanes);
    accumulate(points, second, pose, worth, lanes);
  }
  collect(lanes, sums);
}

}  // namespace

void bind(config::Binder& b, ObjectiveOptions& o) {
  using config::Range;
  b.number("kernel", o.kernel, Range::positive(),
           "width of the Geman-McClure kernel in robust standard deviations");
  b.number("min_scale", o.min_scale, Range::positive(), "floor of the robust standard deviation");
  b.number("line_weight", o.line_weight, Range::non_negative(),
           "weight of a line match; that of a plane match is 1");
}

geometry::Twist MotionModel::velocity_at(const geometry::Pose3& T_map_lidar) const {
  if (!deskew) return geometry::Twist::Zero();
  return geometry::log_se3(T_map_previous.inverse() * T_map_lidar) / interval_s;
}

NormalEquations evaluate(const ScanMatches& matches, const MotionModel& motion,
                         const geometry::Pose3& T_map_lidar, const ObjectiveOptions& options,
                         parallel::Workers& workers) {
  const FloatPose pose(T_map_lidar, matches.origin_map, motion);
  const double k = options.kernel * std::max(matches.scale, options.min_scale);
  const auto k2 = static_cast<float>(k * k);
  const auto line_share = static_cast<float>(options.line_weight);

  const std::size_t lines = matches.line_1.size();
  const std::size_t plane_blocks = (matches.planes.size() + kBlock - 1) / kBlock;
  const std::size_t line_blocks = (lines + kBlock - 1) / kBlock;
  std::vector<Sums> sums(plane_blocks + line_blocks, Sums{});
  workers.run(sums.size(), [&](std::size_t b) {
    if (b < plane_blocks) {
      const std::size_t begin = b * kBlock;
      const std::size_t end = std::min(begin + kBlock, matches.planes.size());
      sum_planes(matches.planes, begin, end, pose, {k2, 1, 1}, sums[b]);
    } else {
      const std::size_t begin = (b - plane_blocks) * kBlock;
      const std::size_t end = std::min(begin + kBlock, lines);
      sum_lines(matches.line_1, matches.line_2, begin, end, pose, {k2, line_share, 0.5F}, sums[b]);
    }
  });

  Sums total{};
  for (const Sums& part : sums) {
    for (std::size_t i = 0; i < kSums; ++i) total[i] += part[i];
  }
  NormalEquations result;
  std::size_t at = 0;
  for (Eigen::Index row = 0; row < 6; ++row) {
    for (Eigen::Index col = row; col < 6; ++col) {
      result.H(row, col) = result.H(col, row) = total[at++];
    }
    result.g[row] = total[kGradient + static_cast<std::size_t>(row)];
  }
  // The rows turn in map axes; the pose is perturbed on the right, in those of the body.
  lidar::Matrix6 axes = lidar::Matrix6::Identity();
  axes.topLeftCorner<3, 3>() = T_map_lidar.rotation;
  result.H = (axes.transpose() * result.H * axes).eval();
  result.g = (axes.transpose() * result.g).eval();
  result.cost = 0.5 * total[kCost];
  result.weight = total[kWeight];
  result.squared_m = total[kSquared];
  result.inliers = total[kInliers];
  return result;
}

}  // namespace traverse::voxel_map
