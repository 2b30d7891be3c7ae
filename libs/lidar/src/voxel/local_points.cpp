#include "traverse/lidar/voxel/local_points.hpp"

#include "traverse/lidar/voxel/cell_grid.hpp"

#include "voxel/workers.hpp"

namespace traverse::lidar::voxel {

SweepMotion::SweepMotion(const geometry::Twist& velocity) {
  for (int k = 0; k < 3; ++k) {
    w[k] = static_cast<float>(velocity[k]);
    v[k] = static_cast<float>(velocity[k + 3]);
  }
}

void to_local(const SweepPoints& points, const geometry::Pose3& T_map_lidar,
              const geometry::Twist& velocity, Workers& workers, LocalPoints& local) {
  constexpr std::size_t kChunk = 4096;
  local.origin_map = origin_near(T_map_lidar.translation);
  for (auto* values : {&local.x, &local.y, &local.z}) values->resize(points.size());
  const SweepMotion motion(velocity);
  const Eigen::Matrix3f R = T_map_lidar.rotation.cast<float>();
  const Eigen::Vector3f t = (T_map_lidar.translation - local.origin_map).cast<float>();
  const float r[9] = {R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1),
                      R(1, 2), R(2, 0), R(2, 1), R(2, 2)};
  const float tx = t.x();
  const float ty = t.y();
  const float tz = t.z();
  workers.run_chunks(points.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    const float* px = points.x.data();
    const float* py = points.y.data();
    const float* pz = points.z.data();
    const float* time = points.time.data();
    float* __restrict out_x = local.x.data();
    float* __restrict out_y = local.y.data();
    float* __restrict out_z = local.z.data();
    const SweepMotion m = motion;
    for (std::size_t i = begin; i < end; ++i) {
      float x = px[i];
      float y = py[i];
      float z = pz[i];
      m.apply(time[i], x, y, z);
      out_x[i] = r[0] * x + r[1] * y + r[2] * z + tx;
      out_y[i] = r[3] * x + r[4] * y + r[5] * z + ty;
      out_z[i] = r[6] * x + r[7] * y + r[8] * z + tz;
    }
  });
}

}  // namespace traverse::lidar::voxel
