#include "traverse/simulation/ray_caster.hpp"

#include <algorithm>
#include <cmath>
#include <embree3/rtcore.h>
#include <stdexcept>
#include <vector>

#include <Eigen/Geometry>
#include <tbb/task_arena.h>

namespace traverse::simulation {

namespace {

constexpr std::size_t kPacket = 8;
constexpr double kNearestHit = 1e-4;  ///< metres: a ray does not meet the surface it starts on
/// Metres by which Embree's single precision may be off; a plane that is met edge-on may seem to be
/// elsewhere.
constexpr double kRounding = 0.01;

struct Plane {
  Eigen::Vector3d normal;  ///< unit
  double offset;           ///< normal . p of its points
};

RTCDevice make_device() {
  RTCDevice device = rtcNewDevice(nullptr);
  if (device == nullptr) throw std::runtime_error("Embree cannot be started");
  return device;
}

}  // namespace

struct RayCaster::Scene {
  RTCDevice device = make_device();
  RTCScene scene = rtcNewScene(device);
  std::vector<Plane> planes;
  std::vector<Material> materials;
  double radius_m = 0;

  Scene() = default;
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
  ~Scene() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }

  /// The exact distance to the triangle that Embree found.
  SurfaceHit refined(const Ray& ray, unsigned triangle, double distance_m) const {
    const Plane& plane = planes[triangle];
    const double slope = plane.normal.dot(ray.direction);
    const double exact = (plane.offset - plane.normal.dot(ray.origin)) / slope;
    SurfaceHit hit;
    hit.distance_m = std::abs(exact - distance_m) < kRounding ? exact : distance_m;
    hit.cosine = std::abs(slope);
    hit.material = materials[triangle];
    return hit;
  }
};

RayCaster::RayCaster(const Mesh& mesh) : scene_(std::make_unique<Scene>()) {
  RTCGeometry geometry = rtcNewGeometry(scene_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* corners = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                              RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                              mesh.corners().size()));
  auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), mesh.size()));
  for (const Eigen::Vector3d& corner : mesh.corners()) {
    corners = std::copy_n(Eigen::Vector3f(corner.cast<float>()).data(), 3, corners);
    scene_->radius_m = std::max(scene_->radius_m, corner.norm());
  }
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const auto& t = mesh.triangles()[i];
    indices = std::copy(t.begin(), t.end(), indices);
    const Eigen::Vector3d& a = mesh.corners()[t[0]];
    const Eigen::Vector3d normal =
        (mesh.corners()[t[1]] - a).cross(mesh.corners()[t[2]] - a).normalized();
    scene_->planes.push_back({normal, normal.dot(a)});
    scene_->materials.push_back(mesh.material(i));
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcSetSceneFlags(scene_->scene, RTC_SCENE_FLAG_ROBUST);  // no ray slips between two triangles
  rtcSetSceneBuildQuality(scene_->scene, RTC_BUILD_QUALITY_MEDIUM);
  // One thread builds the tree, so that it is the same each time. (A device of one thread would do
  // it too, but limits TBB in the whole process.)
  tbb::task_arena alone(1);
  alone.execute([&] { rtcJoinCommitScene(scene_->scene); });
  if (rtcGetDeviceError(scene_->device) != RTC_ERROR_NONE) {
    throw std::runtime_error("Embree cannot take the world: too large for the memory");
  }
}

RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;

double RayCaster::radius_m() const { return scene_->radius_m; }

void RayCaster::cast(std::span<const Ray> rays, double reach_m, std::span<SurfaceHit> hits) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  for (std::size_t begin = 0; begin < rays.size(); begin += kPacket) {
    const std::size_t count = std::min(kPacket, rays.size() - begin);
    alignas(32) int valid[kPacket];  // NOLINT: the types of Embree's interface
    RTCRayHit8 packet;
    for (std::size_t i = 0; i < kPacket; ++i) {
      valid[i] = i < count ? -1 : 0;
      const Ray& ray = rays[begin + std::min(i, count - 1)];
      packet.ray.org_x[i] = static_cast<float>(ray.origin.x());
      packet.ray.org_y[i] = static_cast<float>(ray.origin.y());
      packet.ray.org_z[i] = static_cast<float>(ray.origin.z());
      packet.ray.dir_x[i] = static_cast<float>(ray.direction.x());
      packet.ray.dir_y[i] = static_cast<float>(ray.direction.y());
      packet.ray.dir_z[i] = static_cast<float>(ray.direction.z());
      packet.ray.tnear[i] = static_cast<float>(kNearestHit);
      packet.ray.tfar[i] = static_cast<float>(reach_m);
      packet.ray.time[i] = 0;
      packet.ray.mask[i] = ~0U;
      packet.ray.id[i] = 0;
      packet.ray.flags[i] = 0;
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.primID[i] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect8(valid, scene_->scene, &context, &packet);
    for (std::size_t i = 0; i < count; ++i) {
      const bool is_hit = packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
      hits[begin + i] =
          is_hit ? scene_->refined(rays[begin + i], packet.hit.primID[i], packet.ray.tfar[i])
                 : SurfaceHit();
    }
  }
}

SurfaceHit RayCaster::cast(const Ray& ray, double reach_m) const {
  SurfaceHit hit;
  cast(std::span(&ray, 1), reach_m, std::span(&hit, 1));
  return hit;
}

}  // namespace traverse::simulation
