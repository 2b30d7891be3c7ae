#include "page/scene.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "traverse/render/colour_map.hpp"

#include "charts/series.hpp"
#include "page/packed_points.hpp"
#include "run/nearest_pose.hpp"

namespace traverse::report {

namespace {

/// As many as a page of a few megabytes holds and a browser without a graphics card turns.
constexpr std::size_t kMostPoints = 300'000;
constexpr int kColours = 64;
constexpr std::size_t kMostPoses = std::numeric_limits<std::uint16_t>::max();

ScenePoints map_points(const dataset::PointCloud& map) {
  const auto floats = [&](const char* field) {
    const dataset::FieldValues* values = map.find(field);
    return values == nullptr ? std::vector<float>() : dataset::to_floats(*values);
  };
  const std::vector<float> x = floats("x");
  const std::vector<float> y = floats("y");
  const std::vector<float> z = floats("z");
  const std::vector<float> intensity = floats("intensity");
  ScenePoints points;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Eigen::Vector3f p(x[i], y[i], z[i]);
    if (!p.allFinite()) continue;
    points.positions.push_back(p);
    if (!intensity.empty()) {
      points.intensities.push_back(std::isfinite(intensity[i]) ? intensity[i] : 0);
    }
  }
  return points;
}

Json positions_json(const std::vector<Eigen::Vector3d>& positions) {
  Json list = Json::array();
  for (const auto& p : positions) {
    for (int axis = 0; axis < 3; ++axis) list.push_back(series_number(p[axis]));
  }
  return list;
}

Json estimate_json(const geometry::Trajectory& estimate) {
  std::vector<Eigen::Vector3d> positions;
  Json quaternions = Json::array();
  for (const auto& pose : estimate.poses()) {
    positions.push_back(pose.translation);
    const Eigen::Quaterniond q(pose.rotation);
    for (const double part : {q.x(), q.y(), q.z(), q.w()}) {
      quaternions.push_back(series_number(part));
    }
  }
  return {{"p", positions_json(positions)}, {"q", std::move(quaternions)}};
}

/// The reference brought into the map frame of the estimate, by the alignment backwards.
Json reference_json(const RunData& run) {
  if (!run.reference || !run.evaluation.comparison) return nullptr;
  const auto& alignment = run.evaluation.comparison->alignment;
  const geometry::Pose3 T_estimate_reference = alignment.T_reference_estimate.inverse();
  std::vector<Eigen::Vector3d> positions;
  for (const auto& pose : run.reference->poses()) {
    positions.push_back((T_estimate_reference * pose).translation / alignment.scale);
  }
  return {{"p", positions_json(positions)}};
}

Json error_json(const RunData& run) {
  if (!run.evaluation.comparison) return nullptr;
  const auto* ape = find_ape(*run.evaluation.comparison, evaluation::Relation::kTranslation);
  if (ape == nullptr) return nullptr;
  Json list = Json::array();
  for (const double value : for_each_pose(run, ape->values)) list.push_back(series_number(value));
  return list;
}

Json colours_json(render::ColourMap map) {
  Json list = Json::array();
  for (int k = 0; k < kColours; ++k) {
    const render::Colour c = render::colour_at(map, static_cast<double>(k) / (kColours - 1));
    list.push_back(fmt::format("#{:02x}{:02x}{:02x}", c.red, c.green, c.blue));
  }
  return list;
}

}  // namespace

std::string add_scene(const RunData& run, Model& model) {
  double voxel_m = 0;
  const ScenePoints all = map_points(run.map);
  const ScenePoints points = thinned(all, kMostPoints, voxel_m);
  const std::size_t stride = 1 + run.estimate.size() / kMostPoses;
  const PackedPoints packed = pack(points, nearest_poses(points.positions, run.estimate, stride));
  const Eigen::Vector3d& origin = packed.origin_m;
  model.json["scene"] = {{"points",
                          {{"count", packed.count},
                           {"of", all.positions.size()},
                           {"thinned_to_voxel_m", voxel_m},
                           {"origin_m", {origin.x(), origin.y(), origin.z()}},
                           {"step_m", packed.step_m},
                           {"intensity", packed.intensity},
                           {"pose_stride", stride}}},
                         {"estimate", estimate_json(run.estimate)},
                         {"reference", reference_json(run)},
                         {"error_m", error_json(run)},
                         {"colours",
                          {{"viridis", colours_json(render::ColourMap::kViridis)},
                           {"cividis", colours_json(render::ColourMap::kCividis)}}}};
  return packed.base64;
}

}  // namespace traverse::report
