#include "traverse/lidar/deskew.hpp"

#include <cmath>

#include "traverse/geometry/so3.hpp"

namespace traverse::lidar {

TimedPoints deskewed(const TimedPoints& points, const geometry::Twist& velocity) {
  // Exp(s [w, v]) p = p + s v + A w x p + B w x (w x p + v) + C w x (w x v) with the angle s|w| in
  // A = sin / |w|, B = (1 - cos) / |w|^2, C = (angle - sin) / |w|^3.
  const Eigen::Vector3d w = velocity.head<3>();
  const Eigen::Vector3d v = velocity.tail<3>();
  const double rate = w.norm();
  const Eigen::Matrix3d W = geometry::hat(w);
  const Eigen::Vector3d wwv = W * (W * v);

  TimedPoints result = points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double s = points.time[i];
    const double angle = s * rate;
    const bool small = std::abs(angle) < 1e-4;  // series: the next terms are below 1e-10 relative
    const double A = small ? s : std::sin(angle) / rate;
    const double B = small ? 0.5 * s * s : (1 - std::cos(angle)) / (rate * rate);
    const double C = small ? s * s * s / 6 : (angle - std::sin(angle)) / (rate * rate * rate);
    const Eigen::Vector3d p = points.point(i);
    const Eigen::Vector3d wp = W * p;
    const Eigen::Vector3d q = p + s * v + A * wp + B * (W * (wp + v)) + C * wwv;
    result.x[i] = static_cast<float>(q.x());
    result.y[i] = static_cast<float>(q.y());
    result.z[i] = static_cast<float>(q.z());
  }
  return result;
}

std::string deskew_note(bool wanted, const sensors::LidarProfile& profile,
                        bool motion_compensated) {
  if (!wanted) return "off by configuration";
  if (motion_compensated) return "off: the recording is motion-compensated";
  if (profile.time_source == sensors::TimeSource::kNone) return "off: point times are unknown";
  return "on";
}

}  // namespace traverse::lidar
