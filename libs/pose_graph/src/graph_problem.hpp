#pragma once

#include <deque>
#include <optional>
#include <vector>

#include <ceres/normal_prior.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <ceres/sphere_manifold.h>

#include "traverse/optimization/rotation_manifold.hpp"
#include "traverse/optimization/solution.hpp"

#include "graph_parts.hpp"
#include "pose_costs.hpp"
#include "scaling_loss.hpp"

namespace traverse::pose_graph {

/// A graph as Ceres' problem, whose robust bounds can be wider for a while.
class GraphProblem {
 public:
  /// \param doubts measurements that take no part before the bound is the final one
  GraphProblem(const GraphParts& graph, const Doubts& doubts, const GraphOptions& options,
               const GraphState& state);

  /// The bound in units of the final one, at least 1, at which all loops and fixes without a doubt
  /// have their full weight at the present poses.
  double widest() const;

  /// Moves the poses by up to so many steps that lessen the cost with that bound. Where that
  /// fails, here and below, they stay.
  optimization::Solution stage(double widening, int steps);
  /// Moves them with the final bound until they stay, or for so many iterations.
  optimization::Solution finish(int iterations);

  /// By the present poses and bound; whether that changed anything.
  bool take_in_or_leave_out();

  void take_solution(const GraphState& state) const;

 private:
  /// A pose as Ceres' parameter blocks.
  struct PoseBlocks {
    explicit PoseBlocks(const geometry::Pose3& pose) : q(pose.quaternion()), p(pose.translation) {}
    geometry::Pose3 pose() const { return geometry::Pose3::from_quaternion(q, p); }
    double* rotation() { return q.coeffs().data(); }
    double* translation() { return p.data(); }

    Eigen::Quaterniond q;
    Eigen::Vector3d p;
  };

  /// A constraint that may be false. Far beyond the bound it is left out of the problem, because a
  /// link between distant places makes the equations dense even when it weighs nothing.
  struct DoubtfulFactor {
    ceres::CostFunction* cost;
    ScalingLoss* loss;
    std::vector<double*> parameters;
    bool is_doubted = false;
    ceres::ResidualBlockId block = nullptr;  ///< in the problem, or null

    double chi2() const;
  };

  optimization::Solution solve(double widening, int steps, int iterations, double radius);
  PoseBlocks& at(NodeId node) { return poses_[graph_.index_of.at(node)]; }
  void add(PoseBlocks& pose);
  void add(const Edge& edge, bool is_doubted);
  void add(const Fix& fix, bool is_doubted);
  void add(const Level& level, bool is_doubted);
  void add_offset();
  void add(ceres::CostFunction* cost, ScalingLoss* loss, std::vector<double*> parameters,
           bool is_doubted);
  void hold_gauge();

  const GraphParts graph_;
  const GraphOptions options_;
  std::vector<PoseBlocks> poses_;
  Eigen::Vector3d up_map_, up_offset_;
  std::deque<BetweenCost> between_;
  std::deque<AntennaCost> antennas_;
  std::deque<GravityCost> ups_;
  std::optional<ceres::NormalPrior> offset_prior_;
  std::vector<DoubtfulFactor> doubtful_;
  ScalingLoss loop_loss_;
  ScalingLoss fix_loss_;
  ScalingLoss level_loss_;
  optimization::RotationManifold rotation_manifold_;
  ceres::SphereManifold<3> direction_manifold_;
  ceres::Problem problem_;
  double radius_ = 1e12;  ///< of the trust region at the end of the last solution
};

}  // namespace traverse::pose_graph
