#include "traverse/lidar/timed_points.hpp"

namespace traverse::lidar {

void TimedPoints::clear() {
  for (auto* values : {&x, &y, &z, &time}) values->clear();
}

void TimedPoints::reserve(std::size_t points) {
  for (auto* values : {&x, &y, &z, &time}) values->reserve(points);
}

void TimedPoints::push_back(float px, float py, float pz, float seconds) {
  x.push_back(px);
  y.push_back(py);
  z.push_back(pz);
  time.push_back(seconds);
}

}  // namespace traverse::lidar
