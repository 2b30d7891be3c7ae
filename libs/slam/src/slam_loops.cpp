// How Slam finds loops and tells which to believe; slam.cpp has what it does with them.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Dense>

#include "traverse/geometry/angle.hpp"
#include "traverse/geometry/so3.hpp"
#include "traverse/slam/slam.hpp"

namespace traverse::slam {

namespace {

// A start no farther off than this is drawn in by the registration itself.
constexpr double kDrawnIn_m = 0.8;
constexpr double kDrawnIn_rad = 4 * geometry::kDegree;

double largest_sigma(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(solver.eigenvalues()[2], 0.0));
}

/// Of the pair (rotation, translation) that the pose graph takes, from that of a body twist.
geometry::Matrix6 as_edge(const geometry::Matrix6& of_twist, const geometry::Pose3& T_i_j) {
  geometry::Matrix6 axes = geometry::Matrix6::Identity();
  axes.bottomRightCorner<3, 3>() = T_i_j.rotation;
  return axes * of_twist * axes.transpose();
}

}  // namespace

Slam::Prediction Slam::predict(std::size_t candidate, std::size_t keyframe) const {
  const LoopChecks& checks = options_.loops;
  Prediction prediction;
  prediction.T_candidate_keyframe = graph_.pose(candidate).inverse() * graph_.pose(keyframe);
  // What odometry may have lost since the last loop, or since the candidate if there is none. A
  // loop ties its two ends, so the way is: candidate to its older end, across, and on to here.
  std::size_t since = candidate;
  prediction.covariance.setZero();
  if (last_accepted_) {
    const Loop& last = loops_[*last_accepted_];
    if (last.keyframe > candidate) {
      since = last.keyframe;
      const geometry::Pose3 T_keyframe_candidate = prediction.T_candidate_keyframe.inverse();
      const geometry::Matrix6 to_keyframe = geometry::adjoint(T_keyframe_candidate);
      prediction.covariance +=
          to_keyframe * chain_.covariance(last.candidate, candidate) * to_keyframe.transpose();
      prediction.covariance += last.covariance;
    }
  }
  prediction.covariance += chain_.covariance(since, keyframe);
  const double way_m = chain_.way_m(since, keyframe);
  const double systematic_m = checks.odometry_share * way_m;
  prediction.covariance.bottomRightCorner<3, 3>().diagonal().array() += systematic_m * systematic_m;
  prediction.sigma_m = largest_sigma(prediction.covariance.bottomRightCorner<3, 3>());
  return prediction;
}

void Slam::search_loops(std::size_t keyframe, const Keyframe& content) {
  if (candidates_.findable() == 0) return;
  const std::size_t nearest_in_time = candidates_.findable() - 1;
  const double reach_m = options_.candidates.reach_m;
  const auto gate_m = [&](const Prediction& prediction) {
    return reach_m + options_.candidates.sigmas * prediction.sigma_m;
  };
  const auto record = [&](Loop loop) {
    loops_.push_back(std::move(loop));
    edge_of_loop_.push_back(kNoEdge);
    if (loops_.back().verdict == LoopVerdict::kAccepted) confirm(loops_.back());
    return loops_.back().is_accepted();
  };

  // The most alike first: while the position is uncertain, the nearest one is only a guess.
  const auto alike = candidates_.by_appearance(candidates_.context(keyframe));
  std::optional<std::size_t> tried;
  if (!alike.empty()) {
    const Prediction prediction = predict(alike.front().keyframe, keyframe);
    tried = alike.front().keyframe;
    if (record(verify(alike.front(), LoopSource::kAppearance, content, prediction))) return;
  }
  const Prediction here = predict(nearest_in_time, keyframe);
  const auto near = candidates_.by_position(graph_.pose(keyframe).translation, gate_m(here));
  if (!near) return;
  if (tried && std::max(*tried, near->keyframe) - std::min(*tried, near->keyframe) <= 3) return;
  Candidate candidate = *near;
  const auto match =
      ScanContext::compare(candidates_.context(candidate.keyframe), candidates_.context(keyframe));
  candidate.descriptor_distance = match.distance;
  record(verify(candidate, LoopSource::kPosition, content, predict(candidate.keyframe, keyframe)));
}

Loop Slam::verify(const Candidate& candidate, LoopSource source, const Keyframe& content,
                  const Prediction& prediction) {
  Loop loop;
  loop.keyframe = content.id;
  loop.candidate = candidate.keyframe;
  loop.stamp = content.stamp;
  loop.source = source;
  loop.descriptor_distance = candidate.descriptor_distance;
  loop.prediction_sigma_m = prediction.sigma_m;
  loop.T_candidate_keyframe = prediction.T_candidate_keyframe;
  loop.candidate_stamp = stamps_[candidate.keyframe];

  // Far beyond what odometry can have lost, nothing needs to be registered.
  const double distance_m = prediction.T_candidate_keyframe.translation.norm();
  const double reach_m =
      options_.candidates.reach_m + options_.candidates.sigmas * prediction.sigma_m;
  if (distance_m > reach_m) {
    loop.odometry_chi2 =
        std::pow((distance_m - options_.candidates.reach_m) / prediction.sigma_m, 2);
    loop.verdict = LoopVerdict::kOdometry;
    return loop;
  }

  const auto submap = submap_around(candidate.keyframe);
  loop.candidate = submap->centre;
  loop.candidate_stamp = stamps_[submap->centre];
  const geometry::Pose3 T_centre_candidate = chain_.motion(submap->centre, candidate.keyframe);
  const geometry::Pose3 guess = T_centre_candidate * prediction.T_candidate_keyframe;
  const double sigma_turn = largest_sigma(prediction.covariance.topLeftCorner<3, 3>());
  SearchRegion region;
  region.radius_m = std::max(0.0, 2 * prediction.sigma_m - kDrawnIn_m);
  region.half_turn_rad = std::clamp(2 * sigma_turn - kDrawnIn_rad, 0.0, std::numbers::pi);
  geometry::Pose3 middle = guess;
  if (region.radius_m > options_.candidates.context.reach_m) {
    // Farther than a scan shows surroundings: where odometry lost its way, its guess says nothing.
    // What would be a loop is within reach of the candidate.
    middle.translation = T_centre_candidate.translation;
    region.radius_m = options_.candidates.reach_m;
  }
  const auto starts = starts_around(middle, region, options_.registration);
  const LoopRegistration found =
      register_in(*submap, content.features, starts, options_.registration);

  loop.T_candidate_keyframe = found.T_centre_lidar;
  loop.overlap = found.overlap;
  loop.submap_overlap = submap->own_overlap;
  loop.residual_rms_m = found.health.residual_rms_m;
  loop.weakest_eigenvalue = found.health.observability.eigenvalues[0];
  const LoopChecks& checks = options_.loops;
  geometry::Matrix6 covariance = checks.inflation * found.health.covariance();
  const double turn = checks.min_sigma_deg * geometry::kDegree;
  covariance.diagonal().head<3>().array() += turn * turn;
  covariance.diagonal().tail<3>().array() += checks.min_sigma_m * checks.min_sigma_m;
  const geometry::Twist off = geometry::log_se3(guess.inverse() * found.T_centre_lidar);
  const geometry::Matrix6 expected = prediction.covariance + covariance;
  loop.odometry_chi2 = off.dot(expected.ldlt().solve(off));
  loop.correction_m = off.tail<3>().norm();
  loop.covariance = as_edge(covariance, found.T_centre_lidar);
  loop.verdict = judge(loop, found, found.health.observability.degenerate > 0);
  return loop;
}

LoopVerdict Slam::judge(const Loop& loop, const LoopRegistration& found, bool degenerate) const {
  const LoopChecks& checks = options_.loops;
  if (!found.health.registered) return LoopVerdict::kNotRegistered;
  if (degenerate) return LoopVerdict::kDegenerate;
  if (loop.overlap < checks.min_overlap * loop.submap_overlap) return LoopVerdict::kLittleOverlap;
  if (loop.residual_rms_m > checks.max_residual_m) return LoopVerdict::kResidual;
  if (loop.odometry_chi2 > checks.max_chi2) return LoopVerdict::kOdometry;
  return LoopVerdict::kAccepted;
}

bool Slam::agree(const Loop& a, const Loop& b) const {
  const geometry::Pose3 around = chain_.motion(a.candidate, b.candidate) * b.T_candidate_keyframe *
                                 chain_.motion(b.keyframe, a.keyframe) *
                                 a.T_candidate_keyframe.inverse();
  return around.translation.norm() <= options_.loops.agreement_m &&
         geometry::angle_of(around.rotation) <= options_.loops.agreement_deg * geometry::kDegree;
}

void Slam::confirm(Loop& loop) {
  if (loop.prediction_sigma_m <= options_.loops.confirmed_within_m) {
    accept(loop);
    return;
  }
  const auto earliest = static_cast<std::size_t>(options_.loops.witnesses_within);
  loop.verdict = LoopVerdict::kAlone;
  for (Loop& witness : loops_) {
    if (&witness == &loop || witness.keyframe == loop.keyframe) continue;
    if (witness.keyframe + earliest < loop.keyframe) continue;
    if (witness.verdict != LoopVerdict::kAlone && !witness.is_accepted()) continue;
    if (!agree(witness, loop)) continue;
    if (!witness.is_accepted()) accept(witness);
    if (!loop.is_accepted()) accept(loop);
  }
}

}  // namespace traverse::slam
