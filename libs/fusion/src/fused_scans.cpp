#include "fused_scans.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "traverse/geometry/angle.hpp"
#include "traverse/geometry/so3.hpp"
#include "traverse/lidar/stopwatch.hpp"
#include "traverse/voxel_map/matched_points.hpp"

namespace traverse::fusion {

using geometry::Pose3;
using geometry::Stamp;
using inertial::NavState;
using lidar::Matrix6;
using lidar::Vector6;
using optimization::Termination;
using sensors::ImuSample;
using voxel_map::SweepPoints;
using voxel_map::SweepSample;

namespace {

/// Of a scan whose points are deskewed already.
voxel_map::MotionModel no_motion() {
  voxel_map::MotionModel motion;
  motion.deskew = false;
  return motion;
}

/// Of a perturbation (rotation, R' translation in the map) `shares` of its parts along the
/// directions that the matches tell apart.
Matrix6 shared(const lidar::Observability& seen, const Vector6& shares,
               const Eigen::Matrix3d& R_map_lidar) {
  // u = S d are the scaled coordinates of the twist d = (rotation, R' translation in the map).
  Matrix6 to_scaled = Matrix6::Identity();
  to_scaled.topLeftCorner<3, 3>() *= seen.rotation_scale_m;
  to_scaled.bottomRightCorner<3, 3>() = R_map_lidar.transpose();
  Matrix6 from_scaled = Matrix6::Identity();
  from_scaled.topLeftCorner<3, 3>() /= seen.rotation_scale_m;
  from_scaled.bottomRightCorner<3, 3>() = R_map_lidar;
  return from_scaled * seen.directions * shares.asDiagonal() * seen.directions.transpose() *
         to_scaled;
}

/// H and g with so much of their information on each direction that the matches tell apart. Where
/// the least point lies along it stays: the directions are the axes of H.
void keep_shares(const lidar::Observability& seen, const Vector6& shares,
                 const Eigen::Matrix3d& R_map_lidar, Matrix6& H, Vector6& g) {
  if (shares.minCoeff() >= 1) return;
  const Matrix6 root = shared(seen, shares.cwiseSqrt(), R_map_lidar);
  H = (root.transpose() * H * root).eval();
  g = (shared(seen, shares, R_map_lidar).transpose() * g).eval();
}

/// The least point of the quadratic g' d + d' H d / 2 in the directions that H tells of.
Vector6 least_point(const Matrix6& H, const Vector6& g) {
  constexpr double kNothing = 1e-9;  // of the largest
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(H);
  const Vector6& values = eigen.eigenvalues();
  Vector6 coordinates = eigen.eigenvectors().transpose() * g;
  for (Eigen::Index k = 0; k < 6; ++k) {
    coordinates[k] = values[k] > kNothing * values[5] ? -coordinates[k] / values[k] : 0;
  }
  return eigen.eigenvectors() * coordinates;
}

Matrix6 positive_part(const Matrix6& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(symmetric);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() *
         eigen.eigenvectors().transpose();
}

/// Room for a sample's points, with everything but their coordinates.
void copy_points(const SweepPoints& from, SweepPoints& to) {
  to.x.resize(from.size());
  to.y.resize(from.size());
  to.z.resize(from.size());
  to.range = from.range;
  to.time = from.time;
  to.source = from.source;
  to.step_variance = from.step_variance;
}

}  // namespace

FusedScans::FusedScans(const InertialOdometryOptions& options, const FusedMounts& mounts,
                       const FirstState& first, voxel_map::VoxelMap map,
                       const voxel_map::PoseUncertainty& known, bool deskews, double sweep_s,
                       std::size_t frames, std::shared_ptr<parallel::Workers> workers)
    : options_(options),
      mounts_(mounts),
      deskews_(deskews),
      sweep_s_(sweep_s),
      workers_(std::move(workers)),
      chain_({options.imu, options.window, options.wheels}, mounts.wheels, first.gravity_map),
      map_(std::move(map)),
      frames_(frames),
      uncertainty_(known) {
  chain_.start(first.state, first.sigma);
}

Pose3 FusedScans::lidar_pose(const NavState& x) const {
  const Pose3 T_map_body = x.T_map_body();
  return {T_map_body.rotation, T_map_body * mounts_.p_lidar_body};
}

SweepPath FusedScans::path_at(const NavState& x) const {
  return {sweep_readings_, x, chain_.gravity_map(), mounts_.p_lidar_body, first_s_, last_s_};
}

/// Where the IMU has a gap, two readings that go on as the newest state moves: that far apart, they
/// count for little.
std::vector<ImuSample> FusedScans::readings_between(Stamp from, Stamp to, const ImuReadings& imu) {
  if (imu.longest_gap_s(from, to) <= options_.start.longest_gap_s) return imu.between(from, to);
  const NavState& x = chain_.newest();
  ImuSample first;
  first.stamp = from;
  first.angular_rate = turning_ + x.gyro_bias;
  first.specific_force = x.accelerometer_bias - x.rotation().transpose() * chain_.gravity_map();
  ImuSample last = first;
  last.stamp = to;
  return {first, last};
}

void FusedScans::deskew(const SweepSample& sample, const SweepPath& path) {
  path.apply(sample.planar, deskewed_.planar);
  path.apply(sample.edges, deskewed_.edges);
}

lidar::Frame FusedScans::add(const SweepSample& sample, const ImuReadings& imu,
                             std::span<const sensors::WheelOdometry> wheels) {
  lidar::Frame frame;
  frame.index = frames_++;
  frame.stamp = sample.stamp;
  frame.points = sample.points;
  frame.dropped = sample.dropped;
  frame.class_counts = sample.class_counts();
  frame.ms.organise = sample.organise_ms;
  frame.ms.features = sample.features_ms;

  lidar::Stopwatch watch;
  const NavState before = chain_.newest();
  const Stamp last = before.stamp;
  Stamp middle = geometry::shifted(sample.stamp, sample.middle_s);
  if (middle <= last) middle = geometry::shifted(last, sweep_s_);
  if (imu.longest_gap_s(last, middle) > options_.start.longest_gap_s) {
    ++events_["gaps in the IMU's readings, where constant velocity stood in"];
  }
  const Pose3 lidar_before = lidar_pose(before);
  const Matrix6 covariance_before = lidar_covariance();
  chain_.append(readings_between(last, middle, imu), wheels);
  const Matrix6 predicted = lidar_covariance();
  watch.lap(frame.ms.solve);

  const auto [first_s, last_s] = voxel_map::time_span(sample);
  first_s_ = std::min({0.0, first_s, -sample.middle_s});
  last_s_ = std::max({0.0, last_s, -sample.middle_s});
  sweep_readings_ = readings_between(geometry::shifted(middle, first_s_ - 1e-3),
                                     geometry::shifted(middle, last_s_ + 1e-3), imu);
  const auto condensed = register_scan(sample, frame);
  lidar::Stopwatch solving;
  if (condensed) {
    const Vector6 least = least_point(condensed->H, condensed->g);
    note_innovation(*condensed, least);
    inertial::FoundPose found;
    found.T_map_sensor = condensed->T_map_lidar;
    found.T_map_sensor.rotation *= geometry::exp_so3(least.head<3>());
    found.T_map_sensor.translation += least.tail<3>();
    found.p_body = mounts_.p_lidar_body;
    found.information = condensed->H;
    chain_.constrain(found);
  }
  const NavState& x = chain_.newest();
  turning_ = geometry::log_so3(before.rotation().transpose() * x.rotation()) /
             geometry::seconds_between(last, middle);
  const SweepPath path = path_at(x);
  T_map_last_ = lidar_pose(x);
  note_uncertainty(lidar_before, covariance_before, predicted, frame);
  frame.covariance = uncertainty_.covariance(T_map_last_);
  frame.T_map_lidar = T_map_last_ * path.at(-sample.middle_s);
  frame.T_map_lidar = frame.T_map_lidar.orthonormalised();
  frame.velocity = path.mean_velocity();
  solving.lap(frame.ms.solve);

  swept_.push_back({sample.stamp, -sample.middle_s, path});
  constexpr std::size_t kRemembered = 32;  // sweeps: loops are closed with the latest
  if (swept_.size() > kRemembered) swept_.pop_front();
  if ((frame.health.registered && is_new_view()) ||
      map_.size() < static_cast<std::size_t>(options_.lidar.alignment.min_matches)) {
    insert(sample, frame);
  }
  frame.map_points = map_.size();
  return frame;
}

/// The normalised innovation squared of the pose where the matches have it, by what is left of
/// prediction and matches at their best compromise, which is the same.
void FusedScans::note_innovation(const Condensed& found, const Vector6& least) {
  constexpr double kMemory = 40;  // scans
  constexpr double kMost = 1e4;   // one scan alone is no proof
  const NavState& predicted = chain_.newest();
  const Pose3 at = lidar_pose(predicted);
  Vector6 apart;  // of the matches' pose from the prediction
  apart.head<3>() = geometry::log_so3(at.rotation.transpose() * found.T_map_lidar.rotation *
                                      geometry::exp_so3(least.head<3>()));
  apart.tail<3>() = found.T_map_lidar.translation + least.tail<3>() - at.translation;
  const Matrix6 A = lidar_by_body(predicted);
  const Matrix6 Lambda = (A * chain_.covariance().topLeftCorner<6, 6>() * A.transpose())
                             .llt()
                             .solve(Matrix6::Identity());
  const Vector6 moved = (found.H + Lambda).llt().solve(found.H * apart);
  const double chi2 = apart.dot(found.H * (apart - moved));
  innovation_ = std::min(chi2 / 6, kMost);
  disagreement_ += (innovation_ - disagreement_) / kMemory;
}

/// The chain's covariance of the lidar's pose, as a twist about it in the axes of the map.
Matrix6 FusedScans::lidar_covariance() const {
  const Matrix6 moved = lidar_twist_by_body(chain_.newest());
  return moved * chain_.covariance().topLeftCorner<6, 6>() * moved.transpose();
}

Matrix6 FusedScans::lidar_twist_by_body(const NavState& x) const {
  Matrix6 turned = Matrix6::Identity();
  turned.topLeftCorner<3, 3>() = x.rotation();
  return turned * lidar_by_body(x);
}

/// \param covariance_before  of the lidar's pose, after the last scan  \param predicted  of this
/// one's, by the chain
void FusedScans::note_uncertainty(const Pose3& T_map_before, const Matrix6& covariance_before,
                                  const Matrix6& predicted, const lidar::Frame& frame) {
  const Pose3 step{Eigen::Matrix3d::Identity(), T_map_before.translation - T_map_last_.translation};
  const Matrix6 moved = voxel_map::about_the_origin(step);
  const Matrix6 origin = voxel_map::about_the_origin(T_map_last_);
  const Matrix6 growth = origin *
                         positive_part(predicted - moved * covariance_before * moved.transpose()) *
                         origin.transpose();
  if (!frame.health.registered) {
    uncertainty_.add_prediction(growth);
    return;
  }
  const voxel_map::ObjectiveOptions& objective = options_.lidar.alignment.objective;
  voxel_map::ScanEvidence evidence =
      voxel_map::scan_evidence(matches_, no_motion(), T_map_last_, objective);
  const double scale = std::max(matches_.scale, objective.min_scale);
  evidence.scale(options_.information_share / (scale * scale));
  if (shares_.minCoeff() < 1) {
    Matrix6 axes = Matrix6::Identity();
    axes.topLeftCorner<3, 3>() = T_map_last_.rotation;
    const Eigen::Matrix3d& R = T_map_last_.rotation;
    const lidar::Observability& seen = frame.health.observability;
    evidence.keep(axes * shared(seen, shares_.cwiseSqrt(), R) * axes.transpose(),
                  axes * shared(seen, shares_, R) * axes.transpose());
  }
  uncertainty_.add(evidence, T_map_last_, is_new_view(), predicted.llt().solve(Matrix6::Identity()),
                   growth);
}

/// How a perturbation of the body's pose moves that of the lidar.
Matrix6 FusedScans::lidar_by_body(const NavState& x) const {
  Matrix6 A = Matrix6::Identity();
  A.bottomLeftCorner<3, 3>() = -x.rotation() * geometry::hat(mounts_.p_lidar_body);
  return A;
}

/// Rounds of association and one step each. \returns the matches of the last round
std::optional<FusedScans::Condensed> FusedScans::register_scan(const SweepSample& sample,
                                                               lidar::Frame& frame) {
  constexpr double kStale_m = 0.002;  // by which points of a sweep's end may be off
  const voxel_map::AlignmentOptions& alignment = options_.lidar.alignment;
  lidar::RegistrationHealth& health = frame.health;
  const NavState predicted = chain_.newest();
  const NavState::Matrix& P = chain_.covariance();
  const Matrix6 Lambda = P.topLeftCorner<6, 6>().llt().solve(Matrix6::Identity());
  const Eigen::Matrix<double, NavState::kTangent, 6> gain = P.leftCols<6>() * Lambda;
  const double scale_m = voxel_map::usual_range_m(sample);
  copy_points(sample.planar, deskewed_.planar);
  copy_points(sample.edges, deskewed_.edges);
  matches_.forget();

  NavState x = predicted;
  NavState deskewed_at = predicted;
  std::optional<Condensed> last;
  Vector6 moved = Vector6::Zero();  // of the pose since the prediction
  health.end(Termination::kIterationLimit);
  for (int round = 0; round < alignment.rounds; ++round) {
    lidar::Stopwatch watch;
    const double turned =
        (x.rotation().transpose() * deskewed_at.rotation() - Eigen::Matrix3d::Identity()).norm();
    const double speed_changed = (x.v_map - deskewed_at.v_map).norm() + turned * x.v_map.norm();
    if (round == 0 || speed_changed * std::max(-first_s_, last_s_) > kStale_m) {
      deskew(sample, deskews_ ? path_at(x) : SweepPath());
      deskewed_at = x;
    }
    watch.lap(frame.ms.deskew);
    const double halved = alignment.gate_m * std::pow(0.5, std::max(0, round - 1));
    const auto found =
        condense(lidar_pose(x), std::max(halved, alignment.narrow_gate_m), scale_m, frame);
    if (!found) return std::nullopt;
    last = found;

    lidar::Stopwatch solving;
    const Matrix6 A = lidar_by_body(x);
    const Matrix6 H = A.transpose() * found->H * A;
    const Vector6 g = A.transpose() * found->g;
    const Vector6 step = -(H + Lambda).llt().solve(g + Lambda * moved);
    moved += step;
    x = predicted.plus(gain * moved);
    health.iterations += 1;
    solving.lap(frame.ms.solve);
    if (round >= 1 && step.tail<3>().norm() < alignment.converged_m &&
        step.head<3>().norm() < geometry::kDegree * alignment.converged_deg) {
      health.end(Termination::kConverged);
      break;
    }
  }
  return last;
}

std::optional<FusedScans::Condensed> FusedScans::condense(const Pose3& T_map_lidar, double gate_m,
                                                          double scale_m, lidar::Frame& frame) {
  const voxel_map::AlignmentOptions& alignment = options_.lidar.alignment;
  lidar::RegistrationHealth& health = frame.health;
  const voxel_map::MotionModel motion = no_motion();
  voxel_map::associate_at(deskewed_, T_map_lidar, motion, map_, gate_m, alignment.matches,
                          *workers_, moved_, matches_, frame.ms);
  lidar::Stopwatch watch;
  ++health.steps;
  health.line_matches = matches_.line_1.size();
  health.plane_matches = matches_.planes.size();
  if (matches_.size() < static_cast<std::size_t>(alignment.min_matches)) {
    health.end(Termination::kTooFewMatches);
    health.registered = false;
    health.observability.degenerate = 6;
    return std::nullopt;
  }
  const voxel_map::NormalEquations normal =
      voxel_map::evaluate(matches_, motion, T_map_lidar, alignment.objective, *workers_);
  const auto count = static_cast<double>(matches_.size());
  health.residual_rms_m = std::sqrt(normal.squared_m / count);
  health.inlier_share = normal.inliers / count;
  health.observability = voxel_map::judged_observability(normal, matches_, T_map_lidar, motion,
                                                         scale_m, alignment.min_eigenvalue);
  health.registered = true;
  const double scale = std::max(matches_.scale, alignment.objective.min_scale);
  const double share = options_.information_share / (scale * scale);
  Condensed condensed{T_map_lidar, share * normal.H, share * normal.g};
  shares_ = voxel_map::facing_shares(health.observability, matches_, T_map_lidar, motion);
  keep_shares(health.observability, shares_, T_map_lidar.rotation, condensed.H, condensed.g);
  watch.lap(frame.ms.solve);
  return condensed;
}

/// A scan from where the last one was taken has its points on the same rings: what lies between
/// them it does not show, and planes and lines that only follow a ring would look well seen. They
/// say that nothing moves, and hold the attitude when a vehicle lifts its nose to go.
bool FusedScans::is_new_view() const {
  constexpr double kMoved_m = 0.05;
  constexpr double kTurned = 0.1 * geometry::kDegree;
  if (!T_map_inserted_) return true;
  const Pose3 since = T_map_inserted_->inverse() * T_map_last_;
  return since.translation.norm() > kMoved_m || geometry::angle_of(since.rotation) > kTurned;
}

void FusedScans::insert(const SweepSample& sample, lidar::Frame& frame) {
  lidar::Stopwatch watch;
  const SweepPath path = deskews_ ? swept_.back().path : SweepPath();
  copy_points(sample.surface, deskewed_.surface);
  deskewed_.surface_is_planar = sample.surface_is_planar;
  path.apply(sample.surface, deskewed_.surface);
  path.apply(sample.edges, deskewed_.edges);
  map_.insert(deskewed_, T_map_last_, geometry::Twist::Zero(), *workers_);
  T_map_inserted_ = T_map_last_;
  watch.lap(frame.ms.insert);
}

std::vector<lidar::MatchedPoint> FusedScans::matches() const {
  return voxel_map::matched_points(matches_, T_map_last_, geometry::Twist::Zero());
}

std::size_t FusedScans::bytes() const {
  return map_.bytes() + matches_.bytes() + chain_.bytes() +
         swept_.size() * (sizeof(Swept) + 60 * 12 * sizeof(float));
}

const FusedScans::Swept* FusedScans::sweep_of(Stamp stamp) const {
  const auto found = std::find_if(swept_.rbegin(), swept_.rend(),
                                  [&](const Swept& swept) { return swept.stamp == stamp; });
  return found == swept_.rend() ? nullptr : &*found;
}

}  // namespace traverse::fusion
