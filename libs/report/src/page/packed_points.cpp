#include "page/packed_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <zlib.h>

#include "traverse/geometry/voxel_set.hpp"

#include "page/data_uri.hpp"

namespace traverse::report {

namespace {

constexpr double kFirstVoxel_m = 0.25;
constexpr double kLargestStep = 65535;
constexpr int kCompression = 6;

std::vector<std::size_t> first_of_each_voxel(const std::vector<Eigen::Vector3f>& points,
                                             double voxel_m) {
  geometry::VoxelSet voxels(voxel_m, points.size());
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (voxels.insert(points[i].cast<double>())) chosen.push_back(i);
  }
  return chosen;
}

/// Differences from value to value, low bytes before high bytes.
void add_differences(const std::vector<std::uint16_t>& values, std::string& bytes) {
  std::string high;
  std::uint16_t previous = 0;
  for (const std::uint16_t value : values) {
    const auto difference = static_cast<std::uint16_t>(value - previous);
    bytes.push_back(static_cast<char>(difference & 0xffU));
    high.push_back(static_cast<char>(difference >> 8U));
    previous = value;
  }
  bytes += high;
}

std::string compressed(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string result(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(result.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()),
                kCompression) != Z_OK) {
    throw std::runtime_error("zlib could not compress the points of the map");
  }
  result.resize(size);
  return result;
}

}  // namespace

ScenePoints thinned(const ScenePoints& points, std::size_t most, double& voxel_m) {
  voxel_m = 0;
  if (points.positions.size() <= most) return points;
  std::vector<std::size_t> chosen;
  for (voxel_m = kFirstVoxel_m;; voxel_m *= 1.2) {
    chosen = first_of_each_voxel(points.positions, voxel_m);
    if (chosen.size() <= most) break;
    // Surfaces lose points with the square of the edge: most of the way in one step.
    const double missing = static_cast<double>(chosen.size()) / static_cast<double>(most);
    voxel_m *= std::max(1.0, 0.85 * std::sqrt(missing));
  }
  ScenePoints result;
  for (const std::size_t i : chosen) {
    result.positions.push_back(points.positions[i]);
    if (!points.intensities.empty()) result.intensities.push_back(points.intensities[i]);
  }
  return result;
}

PackedPoints pack(const ScenePoints& points, const std::vector<std::uint16_t>& nearest_pose) {
  PackedPoints packed;
  packed.count = points.positions.size();
  if (points.positions.empty()) return packed;
  Eigen::Vector3f low = points.positions.front();
  Eigen::Vector3f high = low;
  for (const Eigen::Vector3f& p : points.positions) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  packed.origin_m = low.cast<double>();
  packed.step_m = std::max(1e-3, double{(high - low).maxCoeff()} / kLargestStep);

  std::string bytes;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<std::uint16_t> steps;
    for (const Eigen::Vector3f& p : points.positions) {
      const double step = (p.cast<double>() - packed.origin_m)[axis] / packed.step_m;
      steps.push_back(static_cast<std::uint16_t>(std::clamp(std::round(step), 0.0, kLargestStep)));
    }
    add_differences(steps, bytes);
  }
  add_differences(nearest_pose, bytes);
  if (!points.intensities.empty()) {
    const auto [least, most] =
        std::minmax_element(points.intensities.begin(), points.intensities.end());
    packed.intensity = {*least, *most};
    const float factor = *most > *least ? 255 / (*most - *least) : 0;
    for (const float value : points.intensities) {
      bytes.push_back(static_cast<char>(std::lround((value - *least) * factor)));
    }
  } else {
    bytes.append(points.positions.size(), '\0');
  }
  packed.base64 = base64(compressed(bytes));
  return packed;
}

}  // namespace traverse::report
