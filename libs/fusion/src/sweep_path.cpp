#include "sweep_path.hpp"

#include <algorithm>
#include <cmath>

#include "traverse/geometry/so3.hpp"
#include "traverse/inertial/interpolated_reading.hpp"

namespace traverse::fusion {

using geometry::seconds_between;
using sensors::ImuSample;

namespace {

/// Between knots rotations are mixed linearly: at 10 rad/s that is off by 5e-5 rad.
constexpr double kKnotEvery = 0.002;  // s

/// The body at a moment, as integration carries it along.
struct Carried {
  Eigen::Matrix3d R;
  Eigen::Vector3d p;
  Eigen::Vector3d v;
};

/// Readings by seconds after the middle, asked for nearly in order.
class ReadingAt {
 public:
  ReadingAt(std::span<const ImuSample> readings, geometry::Stamp middle)
      : readings_(readings), middle_(middle) {}

  ImuSample operator()(double seconds) {
    const geometry::Stamp stamp = geometry::shifted(middle_, seconds);
    while (after_ + 1 < readings_.size() && readings_[after_].stamp < stamp) ++after_;
    while (after_ > 1 && readings_[after_ - 1].stamp > stamp) --after_;
    if (readings_.size() < 2) return readings_[0];
    if (stamp <= readings_[after_ - 1].stamp) return readings_[after_ - 1];
    if (stamp >= readings_[after_].stamp) return readings_[after_];
    return inertial::interpolated(readings_[after_ - 1], readings_[after_], stamp);
  }

 private:
  std::span<const ImuSample> readings_;
  geometry::Stamp middle_;
  std::size_t after_ = 1;
};

/// By the midpoint rule; backwards where `step` is negative.
void carry(const ImuSample& reading, const inertial::NavState& middle,
           const Eigen::Vector3d& gravity_map, double step, Carried& body) {
  const Eigen::Vector3d turn = step * (reading.angular_rate - middle.gyro_bias);
  const Eigen::Matrix3d half = body.R * geometry::exp_so3(0.5 * turn);
  const Eigen::Vector3d acceleration =
      half * (reading.specific_force - middle.accelerometer_bias) + gravity_map;
  body.R = body.R * geometry::exp_so3(turn);
  body.p += step * body.v + 0.5 * step * step * acceleration;
  body.v += step * acceleration;
}

}  // namespace

SweepPath::SweepPath(std::span<const ImuSample> readings, const inertial::NavState& middle,
                     const Eigen::Vector3d& gravity_map, const Eigen::Vector3d& p_lidar_body,
                     double first_s, double last_s) {
  const double back_s = std::max(0.0, -first_s);
  const auto before = static_cast<std::size_t>(std::ceil(back_s / kKnotEvery));
  const auto behind = static_cast<std::size_t>(std::ceil(std::max(0.0, last_s) / kKnotEvery));
  step_s_ = kKnotEvery;
  first_s_ = -step_s_ * static_cast<double>(before);
  knots_.resize(before + behind + 1);

  const Carried start{middle.rotation(), middle.p_map, middle.v_map};
  const Eigen::Matrix3d R_middle_map = start.R.transpose();
  const Eigen::Vector3d p_lidar_map = start.p + start.R * p_lidar_body;
  const auto note = [&](std::size_t k, const Carried& body) {
    const Eigen::Matrix3d R = R_middle_map * body.R;
    const Eigen::Vector3d t = R_middle_map * (body.p + body.R * p_lidar_body - p_lidar_map);
    Knot& knot = knots_[k];
    for (int i = 0; i < 3; ++i) {
      const auto row = static_cast<std::size_t>(3 * i);
      for (int j = 0; j < 3; ++j)
        knot[row + static_cast<std::size_t>(j)] = static_cast<float>(R(i, j));
      knot[static_cast<std::size_t>(9 + i)] = static_cast<float>(t[i]);
    }
  };
  note(before, start);
  ReadingAt reading_at(readings, middle.stamp);
  Carried body = start;
  for (std::size_t k = 1; k <= behind; ++k) {
    carry(reading_at((static_cast<double>(k) - 0.5) * step_s_), middle, gravity_map, step_s_, body);
    note(before + k, body);
  }
  body = start;
  for (std::size_t k = 1; k <= before; ++k) {
    carry(reading_at((0.5 - static_cast<double>(k)) * step_s_), middle, gravity_map, -step_s_,
          body);
    note(before - k, body);
  }
}

std::size_t SweepPath::place(double seconds, float& share) const {
  const double steps =
      std::clamp((seconds - first_s_) / step_s_, 0.0, static_cast<double>(knots_.size() - 1));
  const auto k = static_cast<std::size_t>(steps);
  share = static_cast<float>(steps - static_cast<double>(k));
  return k;
}

geometry::Pose3 SweepPath::at(double seconds) const {
  float share = 0;
  const std::size_t k = place(seconds, share);
  const Knot& from = knots_[k];
  const Knot& to = knots_[std::min(k + 1, knots_.size() - 1)];
  geometry::Pose3 pose;
  for (int i = 0; i < 3; ++i) {
    const auto mixed = [&](int column) {
      const auto n = static_cast<std::size_t>(column);
      return static_cast<double>(from[n]) + static_cast<double>(share) * (to[n] - from[n]);
    };
    for (int j = 0; j < 3; ++j) pose.rotation(i, j) = mixed(3 * i + j);
    pose.translation[i] = mixed(9 + i);
  }
  return pose.orthonormalised();
}

void SweepPath::move(float time, float& x, float& y, float& z) const {
  float share = 0;
  const std::size_t k = place(time, share);
  const Knot& from = knots_[k];
  const Knot& to = knots_[std::min(k + 1, knots_.size() - 1)];
  Knot m;
  for (std::size_t i = 0; i < m.size(); ++i) m[i] = from[i] + share * (to[i] - from[i]);
  const float px = x;
  const float py = y;
  const float pz = z;
  x = m[0] * px + m[1] * py + m[2] * pz + m[9];
  y = m[3] * px + m[4] * py + m[5] * pz + m[10];
  z = m[6] * px + m[7] * py + m[8] * pz + m[11];
}

void SweepPath::apply(const voxel_map::SweepPoints& points, voxel_map::SweepPoints& moved) const {
  for (std::size_t i = 0; i < points.size(); ++i) {
    float x = points.x[i];
    float y = points.y[i];
    float z = points.z[i];
    move(points.time[i], x, y, z);
    moved.x[i] = x;
    moved.y[i] = y;
    moved.z[i] = z;
  }
}

void SweepPath::apply(const std::vector<float>& times, double zero_s,
                      lidar::CorrectedScan& points) const {
  const geometry::Pose3 T_zero_middle = at(zero_s).inverse();
  for (std::size_t i = 0; i < times.size(); ++i) {
    move(static_cast<float>(zero_s) + times[i], points.x[i], points.y[i], points.z[i]);
    const Eigen::Vector3d p =
        T_zero_middle * Eigen::Vector3d(points.x[i], points.y[i], points.z[i]);
    points.x[i] = static_cast<float>(p.x());
    points.y[i] = static_cast<float>(p.y());
    points.z[i] = static_cast<float>(p.z());
  }
}

geometry::Twist SweepPath::mean_velocity() const {
  const double seconds = step_s_ * static_cast<double>(knots_.size() - 1);
  if (!(seconds > 0)) return geometry::Twist::Zero();
  const geometry::Pose3 first = at(first_s_);
  const geometry::Pose3 last = at(first_s_ + seconds);
  return geometry::log_se3(first.inverse() * last) / seconds;
}

}  // namespace traverse::fusion
