#include "evidence/distortion_track.hpp"

#include <cmath>
#include <numbers>

#include "traverse/geometry/angle.hpp"
#include "traverse/geometry/so3.hpp"
#include "traverse/sensors/sweep_timing.hpp"

namespace traverse::plausibility {

namespace {

constexpr std::size_t kMaxCompared = 12;
constexpr std::size_t kMaxWaiting = 16;
constexpr std::size_t kPointsOfPlanes = 30'000;
constexpr std::size_t kPointsOnThem = 5'000;

}  // namespace

void DistortionTrack::take(const std::shared_ptr<const sensors::LidarScan>& scan) {
  if (compared_ >= kMaxCompared) return;
  waiting_.push_back(scan);
  if (waiting_.size() > kMaxWaiting) waiting_.pop_front();
}

void DistortionTrack::take_pose(geometry::Stamp stamp, const geometry::Pose3& T_map_body,
                                const sensors::Rig& rig) {
  if (compared_ >= kMaxCompared) return;
  while (!waiting_.empty() && waiting_.front()->stamp < stamp) waiting_.pop_front();
  if (waiting_.empty() || waiting_.front()->stamp != stamp) return;
  PosedScan now{stamp, waiting_.front(), {}, {}};
  waiting_.pop_front();
  const sensors::MountedSensor* lidar = rig.find(now.scan->sensor);
  if (lidar == nullptr || !lidar->lidar) return;
  now.T_map_lidar = T_map_body * lidar->T_body_sensor;
  if (last_) {
    // A vehicle pitches within a few sweeps: the motion of a scan is that between its neighbours.
    constexpr double kLongestInterval_s = 0.25;
    const double before_s = interval_s_;
    interval_s_ = sensors::scan_interval(last_->stamp, stamp, *lidar->lidar);
    const bool is_steady = interval_s_ > 0 && interval_s_ < kLongestInterval_s &&
                           std::abs(interval_s_ - before_s) < 0.5 * interval_s_;
    if (is_steady && last_but_one_) {
      const geometry::Pose3 step = last_but_one_->inverse() * now.T_map_lidar;
      last_->velocity = geometry::log_se3(step) / (before_s + interval_s_);
      if (is_fast(*last_)) pair_up(*last_, *lidar->lidar);
    }
    last_but_one_ = last_->T_map_lidar;
  }
  last_ = now;
  if (compared_ < kMaxCompared) return;
  stops_.clear();
  waiting_.clear();
  last_.reset();
}

/// A scan every two metres is kept; each is compared with the first that is five behind it, so that
/// a short path has pairs too and no two pairs are the same.
void DistortionTrack::pair_up(const PosedScan& now, const sensors::LidarProfile& profile) {
  constexpr double kMaxTime_s = 5;
  const auto is_apart = [&](const PosedScan& scan, double metres, double angle) {
    const geometry::Pose3 way = scan.T_map_lidar.inverse() * now.T_map_lidar;
    return way.translation.norm() >= metres || geometry::angle_of(way.rotation) >= angle;
  };
  std::erase_if(stops_, [&](const PosedScan& scan) {
    return geometry::seconds_between(scan.stamp, now.stamp) > kMaxTime_s;
  });
  if (!stops_.empty() && !is_apart(stops_.back(), 2, 10 * geometry::kDegree)) return;
  while (stops_.size() > 1 && is_apart(stops_[1], 5, 25 * geometry::kDegree)) stops_.pop_front();
  if (!stops_.empty() && is_apart(stops_.front(), 5, 25 * geometry::kDegree)) {
    compare(stops_.front(), now, profile);
  }
  stops_.push_back(now);
}

/// What moves less than 0.2 m in a sweep, at 15 m from the lidar, cannot be told from noise.
bool DistortionTrack::is_fast(const PosedScan& scan) const {
  constexpr double kMinMotion_m = 0.2;
  constexpr double kUsualRange_m = 15;
  const double way =
      scan.velocity.tail<3>().norm() + kUsualRange_m * scan.velocity.head<3>().norm();
  return way * interval_s_ > kMinMotion_m;
}

void DistortionTrack::compare(const PosedScan& a, const PosedScan& b,
                              const sensors::LidarProfile& profile) {
  const bool is_known = sensors::PointClock(*a.scan, profile).knows() &&
                        sensors::PointClock(*b.scan, profile).knows();
  std::vector<std::optional<double>> seams_deg{std::nullopt};
  if (!is_known) seams_deg.assign(kSeams_deg.begin(), kSeams_deg.end());
  for (const std::optional<double>& seam_deg : seams_deg) {
    const auto distortion = fit_distortion(timed(a, profile, seam_deg, kPointsOfPlanes),
                                           timed(b, profile, seam_deg, kPointsOnThem));
    if (distortion) pairs_.push_back({seam_deg, *distortion});
  }
  // Four times the work on a pair leaves half as many pairs.
  compared_ += is_known ? 1 : 2;
}

TimedScan DistortionTrack::timed(const PosedScan& scan, const sensors::LidarProfile& profile,
                                 std::optional<double> seam_deg, std::size_t points) const {
  constexpr double kNearest_m = 2;  // the vehicle itself moves along
  constexpr double kFarthest_m = 60;
  sensors::LidarProfile used = profile;
  if (seam_deg) {
    used.time_source = sensors::TimeSource::kAzimuth;
    used.sweep_s = interval_s_;
    used.rotation = sensors::Rotation::kClockwise;
    used.seam_azimuth_deg = *seam_deg;
    used.stamp_fraction = 0.5;
  }
  const sensors::PointClock clock(*scan.scan, used);
  TimedScan result;
  result.T_map_lidar = scan.T_map_lidar;
  result.velocity = scan.velocity;
  const std::size_t step = (scan.scan->size() / points) | 1U;
  for (std::size_t i = 0; i < scan.scan->size(); i += step) {
    const Eigen::Vector3f p(scan.scan->x[i], scan.scan->y[i], scan.scan->z[i]);
    const float range = p.norm();
    if (!(range > kNearest_m && range < kFarthest_m)) continue;
    const float time = clock(i);
    if (!std::isfinite(time)) continue;
    result.points.push_back(p);
    result.times.push_back(time);
  }
  return result;
}

}  // namespace traverse::plausibility
