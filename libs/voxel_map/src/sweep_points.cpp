#include "traverse/voxel_map/sweep_points.hpp"

namespace traverse::voxel_map {

void SweepPoints::resize(std::size_t points) {
  for (auto* values : {&x, &y, &z, &range, &time}) values->resize(points);
  source.resize(points);
}

void SweepPoints::reserve(std::size_t points) {
  for (auto* values : {&x, &y, &z, &range, &time}) values->reserve(points);
  source.reserve(points);
}

void SweepPoints::push_back(float px, float py, float pz, float point_range,
                            std::uint32_t point_source) {
  x.push_back(px);
  y.push_back(py);
  z.push_back(pz);
  range.push_back(point_range);
  time.push_back(0);
  source.push_back(point_source);
}

void SweepPoints::append(const SweepPoints& other) {
  const auto add = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  add(x, other.x);
  add(y, other.y);
  add(z, other.z);
  add(range, other.range);
  add(time, other.time);
  add(source, other.source);
  add(step_variance, other.step_variance);
}

void SweepPoints::append(const SweepPoints& other, std::size_t i) {
  push_back(other.x[i], other.y[i], other.z[i], other.range[i], other.source[i]);
  time.back() = other.time[i];
}

}  // namespace traverse::voxel_map
