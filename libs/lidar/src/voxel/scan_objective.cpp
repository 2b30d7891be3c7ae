#include "traverse/lidar/voxel/scan_objective.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "voxel/workers.hpp"

namespace traverse::lidar::voxel {

namespace {

constexpr std::size_t kLanes = 8;
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

/// Rows of a block at a pose: lever arm m, normal n, residual r, squared normalised residual e2,
/// weight and share s of the interval. Padded with zeros to whole lanes.
struct Block {
  std::size_t count = 0;
  alignas(32) std::array<float, kBlock> mx, my, mz, nx, ny, nz, r, e2, weight, s;
};

void fill(const PlaneRows& rows, std::size_t begin, std::size_t count, const FloatPose& pose,
          Block& block) {
  block.count = count;
  const float* __restrict x = rows.x.data() + begin;
  const float* __restrict y = rows.y.data() + begin;
  const float* __restrict z = rows.z.data() + begin;
  const float* __restrict time = rows.time.data() + begin;
  const float* __restrict nx = rows.nx.data() + begin;
  const float* __restrict ny = rows.ny.data() + begin;
  const float* __restrict nz = rows.nz.data() + begin;
  const float* __restrict d = rows.d.data() + begin;
  const float* __restrict weight = rows.weight.data() + begin;
  const FloatPose p = pose;
  for (std::size_t i = 0; i < count; ++i) {
    float qx = x[i];
    float qy = y[i];
    float qz = z[i];
    p.motion.apply(time[i], qx, qy, qz);
    const float mx = p.r[0] * qx + p.r[1] * qy + p.r[2] * qz;
    const float my = p.r[3] * qx + p.r[4] * qy + p.r[5] * qz;
    const float mz = p.r[6] * qx + p.r[7] * qy + p.r[8] * qz;
    const float r = nx[i] * (mx + p.t[0]) + ny[i] * (my + p.t[1]) + nz[i] * (mz + p.t[2]) + d[i];
    block.mx[i] = mx;
    block.my[i] = my;
    block.mz[i] = mz;
    block.nx[i] = nx[i];
    block.ny[i] = ny[i];
    block.nz[i] = nz[i];
    block.r[i] = r;
    block.weight[i] = weight[i];
    block.e2[i] = r * r * weight[i];
    block.s[i] = time[i] * p.per_interval;
  }
  for (std::size_t i = count; i % kLanes != 0; ++i) {
    for (auto* values : {&block.mx, &block.my, &block.mz, &block.nx, &block.ny, &block.nz, &block.r,
                         &block.e2, &block.weight, &block.s}) {
      (*values)[i] = 0;
    }
  }
}

/// \param share of a match in the cost  \param unit of a match that a row is: half for a line's
void accumulate(const Block& b, const FloatPose& pose, float k2, float share, float unit,
                Sums& sums) {
  float acc[kSums][kLanes] = {};
  const FloatPose& p = pose;
  for (std::size_t i = 0; i < b.count; i += kLanes) {
    float w[kLanes];
    float J[6][kLanes];
    for (std::size_t l = 0; l < kLanes; ++l) {
      const float e2 = b.e2[i + l];
      const float u = k2 / (k2 + e2);
      w[l] = share * b.weight[i + l] * u * u;
      const float counted = b.weight[i + l] > 0 ? unit : 0;
      acc[kCost][l] += counted * share * e2 * u;
      acc[kWeight][l] += unit * w[l];
      acc[kSquared][l] += b.r[i + l] * b.r[i + l];
      acc[kInliers][l] += e2 <= k2 ? counted : 0;
    }
    for (std::size_t l = 0; l < kLanes; ++l) {
      const float mx = b.mx[i + l];
      const float my = b.my[i + l];
      const float mz = b.mz[i + l];
      const float nx = b.nx[i + l];
      const float ny = b.ny[i + l];
      const float nz = b.nz[i + l];
      const float jx = my * nz - mz * ny;
      const float jy = mz * nx - mx * nz;
      const float jz = mx * ny - my * nx;
      const float s = b.s[i + l];
      const float f = 1 + s;
      const float a = 0.5F * s * f;
      J[0][l] = f * jx + a * (jy * p.w[2] - jz * p.w[1] + ny * p.v[2] - nz * p.v[1]);
      J[1][l] = f * jy + a * (jz * p.w[0] - jx * p.w[2] + nz * p.v[0] - nx * p.v[2]);
      J[2][l] = f * jz + a * (jx * p.w[1] - jy * p.w[0] + nx * p.v[1] - ny * p.v[0]);
      J[3][l] = f * nx + a * (ny * p.w[2] - nz * p.w[1]);
      J[4][l] = f * ny + a * (nz * p.w[0] - nx * p.w[2]);
      J[5][l] = f * nz + a * (nx * p.w[1] - ny * p.w[0]);
    }
    std::size_t k = 0;
    for (std::size_t row = 0; row < 6; ++row) {
      float wj[kLanes];
      for (std::size_t l = 0; l < kLanes; ++l) wj[l] = w[l] * J[row][l];
      for (std::size_t col = row; col < 6; ++col, ++k) {
        for (std::size_t l = 0; l < kLanes; ++l) acc[k][l] += wj[l] * J[col][l];
      }
      for (std::size_t l = 0; l < kLanes; ++l) acc[kGradient + row][l] += wj[l] * b.r[i + l];
    }
  }
  for (std::size_t k = 0; k < kSums; ++k) {
    for (std::size_t l = 0; l < kLanes; ++l) sums[k] += acc[k][l];
  }
}

}  // namespace

void bind(config::Binder& b, ObjectiveOptions& o) {
  using config::Range;
  b.number("kernel", o.kernel, Range::positive(),
           "width of the Geman-McClure kernel in robust standard deviations");
  b.number("least_scale", o.least_scale, Range::positive(),
           "the robust standard deviation is not taken smaller");
  b.number("line_weight", o.line_weight, Range::non_negative(), "of a line match; a plane's is 1");
}

geometry::Twist MotionModel::velocity_at(const geometry::Pose3& T_map_lidar) const {
  if (!deskew) return geometry::Twist::Zero();
  return geometry::log_se3(T_map_previous.inverse() * T_map_lidar) / interval_s;
}

NormalEquations evaluate(const ScanMatches& matches, const MotionModel& motion,
                         const geometry::Pose3& T_map_lidar, const ObjectiveOptions& options,
                         Workers& workers) {
  const FloatPose pose(T_map_lidar, matches.origin_map, motion);
  const double k = options.kernel * std::max(matches.scale, options.least_scale);
  const auto k2 = static_cast<float>(k * k);
  const auto line_share = static_cast<float>(options.line_weight);

  const std::size_t lines = matches.line_1.size();
  const std::size_t plane_blocks = (matches.planes.size() + kBlock - 1) / kBlock;
  const std::size_t line_blocks = (lines + kBlock - 1) / kBlock;
  std::vector<Sums> sums(plane_blocks + line_blocks, Sums{});
  workers.run(sums.size(), [&](std::size_t b) {
    if (b < plane_blocks) {
      const std::size_t begin = b * kBlock;
      Block block;
      fill(matches.planes, begin, std::min(kBlock, matches.planes.size() - begin), pose, block);
      accumulate(block, pose, k2, 1, 1, sums[b]);
      return;
    }
    const std::size_t begin = (b - plane_blocks) * kBlock;
    const std::size_t count = std::min(kBlock, lines - begin);
    Block first;
    Block second;
    fill(matches.line_1, begin, count, pose, first);
    fill(matches.line_2, begin, count, pose, second);
    for (std::size_t i = 0; i < count; ++i) {
      const float joint = first.e2[i] + second.e2[i];
      first.e2[i] = joint;
      second.e2[i] = joint;
    }
    accumulate(first, pose, k2, line_share, 0.5F, sums[b]);
    accumulate(second, pose, k2, line_share, 0.5F, sums[b]);
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
  Matrix6 axes = Matrix6::Identity();
  axes.topLeftCorner<3, 3>() = T_map_lidar.rotation;
  result.H = (axes.transpose() * result.H * axes).eval();
  result.g = (axes.transpose() * result.g).eval();
  result.cost = 0.5 * total[kCost];
  result.weight = total[kWeight];
  result.squared_m = total[kSquared];
  result.inliers = total[kInliers];
  return result;
}

}  // namespace traverse::lidar::voxel
