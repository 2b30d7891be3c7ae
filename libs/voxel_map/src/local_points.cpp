#include "traverse/voxel_map/local_points.hpp"

#include "traverse/parallel/workers.hpp"
#include "traverse/voxel_map/cell_grid.hpp"

#include "lanes.hpp"

namespace traverse::voxel_map {

namespace {

struct FloatTransform {
  float r[9], t[3];
};

TRAVERSE_AVX2_TOO
void transform(const float* __restrict px, const float* __restrict py, const float* __restrict pz,
               const float* __restrict time, std::size_t count, const SweepMotion& motion,
               const FloatTransform& to, float* __restrict out_x, float* __restrict out_y,
               float* __restrict out_z) {
  const SweepMotion m = motion;
  const FloatTransform f = to;
  for (std::size_t i = 0; i < count; ++i) {
    float x = px[i];
    float y = py[i];
    float z = pz[i];
    m.apply(time[i], x, y, z);
    out_x[i] = f.r[0] * x + f.r[1] * y + f.r[2] * z + f.t[0];
    out_y[i] = f.r[3] * x + f.r[4] * y + f.r[5] * z + f.t[1];
    out_z[i] = f.r[6] * x + f.r[7] * y + f.r[8] * z + f.t[2];
  }
}

}  // namespace

SweepMotion::SweepMotion(const geometry::Twist& velocity) {
  for (int k = 0; k < 3; ++k) {
    w[k] = static_cast<float>(velocity[k]);
    v[k] = static_cast<float>(velocity[k + 3]);
  }
}

void to_local(const SweepPoints& points, const geometry::Pose3& T_map_lidar,
              const geometry::Twist& velocity, parallel::Workers& workers, LocalPoints& local) {
  constexpr std::size_t kChunk = 4096;
  local.origin_map = origin_near(T_map_lidar.translation);
  for (auto* values : {&local.x, &local.y, &local.z}) values->resize(points.size());
  const SweepMotion motion(velocity);
  FloatTransform to;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) to.r[3 * i + j] = static_cast<float>(T_map_lidar.rotation(i, j));
    to.t[i] = static_cast<float>(T_map_lidar.translation[i] - local.origin_map[i]);
  }
  workers.run_chunks(points.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    transform(&points.x[begin], &points.y[begin], &points.z[begin], &points.time[begin],
              end - begin, motion, to, &local.x[begin], &local.y[begin], &local.z[begin]);
  });
}

}  // namespace traverse::voxel_map
