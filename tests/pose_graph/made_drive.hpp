#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "traverse/geometry/pose3.hpp"
#include "traverse/geometry/se3.hpp"
#include "traverse/geometry/so3.hpp"
#include "traverse/pose_graph/pose_graph.hpp"

namespace traverse::testing {

/// A made drive round a hilly block, several laps, as keyframes with measured motions between them.
struct MadeDrive {
  struct Loop {
    std::size_t i, j;
    geometry::Pose3 T_i_j;
  };

  std::vector<geometry::Pose3> truth;     ///< T_map_body, the first one is the identity
  std::vector<geometry::Pose3> odometry;  ///< chained from steps
  std::vector<geometry::Pose3> steps;     ///< T_{k}_{k+1} as measured
  geometry::Matrix6 step_covariance;
  geometry::Matrix6 loop_covariance;
  std::vector<Loop> loops;        ///< true ones, between laps
  std::vector<Loop> false_loops;  ///< between places that are far apart, and look alike
};

struct MadeDriveOptions {
  std::size_t keyframes_a_lap = 200;
  std::size_t laps = 2;
  double spacing_m = 2;
  double step_sigma_m = 0.02;
  double step_sigma_rad = 0.002;
  double loop_sigma_m = 0.05;
  double loop_sigma_rad = 0.005;
  std::size_t loops = 60;
  double false_share = 0.3;  ///< of all loops, true and false
  std::size_t alike = 1;     ///< successive false loops that agree with each other
};

class Noise {
 public:
  explicit Noise(unsigned seed) : generator_(seed) {}
  double uniform(double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(generator_);
  }
  std::size_t below(std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(generator_);
  }
  Eigen::Vector3d normal(double sigma) {
    std::normal_distribution<double> draw(0, sigma);
    const double x = draw(generator_), y = draw(generator_), z = draw(generator_);
    return {x, y, z};
  }
  /// In the convention of PoseGraph::add_between.
  geometry::Pose3 disturbed(const geometry::Pose3& T_i_j, double sigma_rad, double sigma_m) {
    return {T_i_j.rotation * geometry::exp_so3(normal(sigma_rad)),
            T_i_j.translation + normal(sigma_m)};
  }

 private:
  std::mt19937 generator_;
};

inline geometry::Matrix6 covariance_of(double sigma_rad, double sigma_m) {
  geometry::Matrix6 covariance = geometry::Matrix6::Identity();
  covariance.topLeftCorner<3, 3>() *= sigma_rad * sigma_rad;
  covariance.bottomRightCorner<3, 3>() *= sigma_m * sigma_m;
  return covariance;
}

inline MadeDrive made_drive(const MadeDriveOptions& options, unsigned seed) {
  using geometry::Pose3;
  Noise noise(seed);
  MadeDrive drive;
  const std::size_t lap = options.keyframes_a_lap;
  const std::size_t count = lap * options.laps;
  const double radius = options.spacing_m * static_cast<double>(lap) / (2 * std::numbers::pi);
  std::vector<Pose3> T_world_body;
  for (std::size_t k = 0; k < count; ++k) {  // a lap is a circle with bends, up and down
    const double a = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(lap);
    const double r = radius * (1 + 0.2 * std::cos(3 * a));
    Pose3 pose;
    pose.translation = {r * std::cos(a), r * std::sin(a), 0.02 * radius * std::sin(2 * a)};
    pose.rotation =
        geometry::exp_so3({0, 0, a + std::numbers::pi / 2}) *
        geometry::exp_so3({0.05 * std::sin(2 * a), 0.05 * std::cos(a), 0.2 * std::sin(3 * a)});
    T_world_body.push_back(pose);
  }
  for (const Pose3& pose : T_world_body) {
    drive.truth.push_back(T_world_body.front().inverse() * pose);
  }
  drive.odometry.push_back(Pose3::identity());
  for (std::size_t k = 1; k < count; ++k) {
    drive.steps.push_back(noise.disturbed(drive.truth[k - 1].inverse() * drive.truth[k],
                                          options.step_sigma_rad, options.step_sigma_m));
    drive.odometry.push_back((drive.odometry.back() * drive.steps.back()).orthonormalised());
  }
  drive.step_covariance = covariance_of(options.step_sigma_rad, options.step_sigma_m);
  drive.loop_covariance = covariance_of(options.loop_sigma_rad, options.loop_sigma_m);

  for (std::size_t l = 0; l < options.loops; ++l) {
    const std::size_t j = lap + l * (count - lap) / options.loops;
    const std::size_t i = j - lap * (1 + noise.below(j / lap));
    drive.loops.push_back({i, j,
                           noise.disturbed(drive.truth[i].inverse() * drive.truth[j],
                                           options.loop_sigma_rad, options.loop_sigma_m)});
  }
  const auto false_loops = static_cast<std::size_t>(std::lround(
      options.false_share / (1 - options.false_share) * static_cast<double>(options.loops)));
  while (drive.false_loops.size() < false_loops) {
    const std::size_t i = noise.below(count - options.alike);
    const std::size_t j = noise.below(count - options.alike);
    if (j < i + options.alike + 5) continue;
    if ((drive.truth[i].translation - drive.truth[j].translation).norm() < 10) continue;
    // Two places that look alike: as if the vehicle had come back to where it was.
    const Pose3 apparent = noise.disturbed(Pose3::identity(), 0.1, 1);
    for (std::size_t k = 0; k < options.alike && drive.false_loops.size() < false_loops; ++k) {
      const Pose3 T = (drive.truth[i].inverse() * drive.truth[i + k]).inverse() * apparent *
                      (drive.truth[j].inverse() * drive.truth[j + k]);
      drive.false_loops.push_back(
          {i + k, j + k, noise.disturbed(T, options.loop_sigma_rad, options.loop_sigma_m)});
    }
  }
  return drive;
}

inline pose_graph::PoseGraph odometry_graph(const MadeDrive& drive,
                                            const pose_graph::GraphOptions& options = {}) {
  pose_graph::PoseGraph graph(options);
  for (std::size_t k = 0; k < drive.odometry.size(); ++k) {
    graph.add_node(k, drive.odometry[k]);
    if (k > 0) {
      graph.add_between(k - 1, k, drive.steps[k - 1], drive.step_covariance,
                        pose_graph::EdgeKind::kOdometry);
    }
  }
  return graph;
}

inline void add_loops(pose_graph::PoseGraph& graph, const MadeDrive& drive,
                      const std::vector<MadeDrive::Loop>& loops) {
  for (const auto& loop : loops) {
    graph.add_between(loop.i, loop.j, loop.T_i_j, drive.loop_covariance,
                      pose_graph::EdgeKind::kLoop);
  }
}

/// Root mean square of the distances to the truth, both in the frame of the first pose [m].
inline double position_rmse(const pose_graph::PoseGraph& graph, const MadeDrive& drive) {
  double sum = 0;
  for (std::size_t k = 0; k < drive.truth.size(); ++k) {
    sum += (graph.pose(k).translation - drive.truth[k].translation).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(drive.truth.size()));
}

}  // namespace traverse::testing
