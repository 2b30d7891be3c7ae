#include "pictures/map_points.hpp"

#include <cmath>
#include <stdexcept>

namespace traverse::render {

ColourScale scale_of(const MapPoints& points, const PointValues& values) {
  if (!values.values.empty()) return colour_scale(values.values, values.map);
  ColourScale scale = colour_scale(points.z, values.map);
  for (Range* range : {&scale.shown, &scale.data}) {
    range->low += points.origin.z();
    range->high += points.origin.z();
  }
  return scale;
}

std::vector<ScenePoint> coloured_points(const MapPoints& points, const PointValues& values,
                                        const ColourScale& scale, const Eigen::Vector3d& centre) {
  const Eigen::Vector3d shift = points.origin - centre;
  std::vector<ScenePoint> scene;
  scene.reserve(points.x.size());
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    if (!std::isfinite(points.x[i]) || !std::isfinite(points.y[i]) || !std::isfinite(points.z[i])) {
      continue;
    }
    const double value = values.values.empty() ? points.z[i] + points.origin.z()
                                               : static_cast<double>(values.values[i]);
    scene.push_back({static_cast<float>(points.x[i] + shift.x()),
                     static_cast<float>(points.y[i] + shift.y()),
                     static_cast<float>(points.z[i] + shift.z()), scale(value)});
  }
  return scene;
}

void check_sizes(const MapPoints& points, const PointValues& values) {
  const std::size_t count = points.x.size();
  if (points.y.size() != count || points.z.size() != count ||
      (!values.values.empty() && values.values.size() != count)) {
    throw std::invalid_argument("the arrays of a map's points must agree in size");
  }
}

}  // namespace traverse::render
