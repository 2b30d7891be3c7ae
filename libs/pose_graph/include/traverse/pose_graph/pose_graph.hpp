#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "traverse/geometry/pose3.hpp"
#include "traverse/geometry/se3.hpp"
#include "traverse/optimization/termination.hpp"
#include "traverse/pose_graph/graph_options.hpp"

namespace traverse::pose_graph {

using NodeId = std::size_t;

/// What an optimisation goes out from.
enum class Start { kLastSolution, kGuesses };

/// Where a constraint between two poses comes from. Odometry is believed; loops may be false.
enum class EdgeKind { kOdometry, kLoop };

/// A measured motion between two nodes, and what the solution says of it.
struct Edge {
  NodeId i = 0;
  NodeId j = 0;
  EdgeKind kind = EdgeKind::kOdometry;
  geometry::Pose3 T_i_j;
  geometry::Matrix6 covariance;  ///< as PoseGraph::add_between takes it

  /// At the present poses: (rotation [rad, axes of j], translation [m, axes of i]).
  geometry::Twist residual = geometry::Twist::Zero();
  double chi2 = 0;    ///< residual' covariance^-1 residual, 6 degrees of freedom
  double weight = 1;  ///< its share in the solution, 0 .. 1; below 1 it contradicts the rest

  /// It had so little weight that the solution does without it.
  bool is_rejected() const { return weight < 0.25; }
};

/// A GNSS fix of a node's antenna, and what the solution says of it.
struct Fix {
  NodeId node = 0;
  Eigen::Vector3d antenna_enu;
  Eigen::Matrix3d covariance;
  Eigen::Vector3d antenna_body;

  Eigen::Vector3d residual = Eigen::Vector3d::Zero();  ///< solved less measured [m, ENU]
  double chi2 = 0;                                     ///< 3 degrees of freedom
  double weight = 0;  ///< as of Edge; 0 while the fixes do not orient the map

  bool is_rejected() const { return weight < 0.25; }
};

/// The direction of up at a node, and what the solution says of it.
struct Level {
  NodeId node = 0;
  Eigen::Vector3d up_body;
  double sigma_rad = 0;

  double angle_rad = 0;  ///< between the solved and the measured up
  double chi2 = 0;       ///< 2 degrees of freedom
  double weight = 1;     ///< as of Edge

  bool is_rejected() const { return weight < 0.25; }
};

/// Outcome of one optimisation.
struct Result {
  bool is_usable = false;  ///< if not, nothing was moved, and the message says why
  bool converged = false;
  optimization::Termination reason = optimization::Termination::kNotRun;  ///< of the last stage
  std::string message;      ///< the solver's last word: the reason in detail
  int stages = 0;           ///< of the graduation, the last one included
  int iterations = 0;       ///< of all stages
  double initial_cost = 0;  ///< half the robust sum of squares with the final bound
  double final_cost = 0;
  std::size_t loops = 0;
  std::size_t doubted_loops = 0;  ///< before the first stage: they contradict larger groups
  std::size_t rejected_loops = 0;
  std::size_t fixes = 0;
  std::size_t rejected_fixes = 0;
  std::size_t levels = 0;
  std::size_t rejected_levels = 0;
  bool is_georeferenced = false;  ///< the map frame is ENU
};

/// Poses of keyframes that fit measured motions between them best: odometry from each to the next,
/// loops between those that saw the same place, GNSS fixes, the direction of gravity.
///
/// The map frame is that of the first node, which is held still; as soon as GNSS fixes are spread
/// out far enough to orient the graph it is ENU instead, and no node is held. Up in a map frame
/// that is not ENU is unknown and estimated with the poses. So is what all measured ups are off by,
/// in the body: an accelerometer's bias and how it is mounted.
///
/// Loops, fixes and ups are robust by dynamic covariance scaling (Agarwal et al., "Robust map
/// optimization using dynamic covariance scaling", ICRA 2013): full weight up to a bound on the
/// chi-square, 4 B^2 / (B + chi2)^2 beyond. By itself that rejects true loops after much drift,
/// because they contradict odometry's first guess as much as false ones do; so the bound begins at
/// the largest chi-square, where nothing is rejected, and shrinks by stages as in graduated
/// non-convexity (Yang et al., RA-L 2020), each stage going on from the solution before. Loops that
/// contradict larger groups of loops are kept out of all stages but the last.
///
/// Incremental: optimise() starts from the last solution; nodes added since are placed by their
/// guesses relative to the node that odometry links them to, and only loops added since widen the
/// bound.
class PoseGraph {
 public:
  explicit PoseGraph(const GraphOptions& options = {});

  /// \param T_map_body_guess in any one frame for all nodes: that of odometry
  /// \throws std::invalid_argument if the id is there already
  void add_node(NodeId id, const geometry::Pose3& T_map_body_guess);

  /// \param covariance of (rotation on the right of T_i_j [rad, axes of j], translation [m, axes of
  ///   i]), positive definite
  /// \throws std::invalid_argument for an unknown node, i == j, or such a covariance
  void add_between(NodeId i, NodeId j, const geometry::Pose3& T_i_j,
                   const geometry::Matrix6& covariance, EdgeKind kind);

  /// \param antenna_enu in a local tangent plane, x east [m] \param covariance [m^2, ENU]
  /// \param antenna_body the lever arm: the antenna in the node's body frame [m]
  /// \throws std::invalid_argument as above
  void add_gnss(NodeId i, const Eigen::Vector3d& antenna_enu, const Eigen::Matrix3d& covariance,
                const Eigen::Vector3d& antenna_body);

  /// \param up_body away from the earth's centre, as an accelerometer at rest shows it, body frame;
  ///   any length  \param sigma_rad of its direction
  /// \throws std::invalid_argument as above
  void add_gravity(NodeId i, const Eigen::Vector3d& up_body, double sigma_rad);

  /// Moves the poses. The same bits on every repeat (one thread). Where it cannot be solved (a
  /// measurement that is not finite) the graph is left as it was.
  /// \param start  kGuesses makes the outcome independent of when optimise() was called before
  Result optimise(Start start = Start::kLastSolution);

  std::size_t size() const { return ids_.size(); }
  bool contains(NodeId id) const { return index_of_.contains(id); }
  /// T_map_body: the solution, for nodes added since the guess carried on from it.
  std::map<NodeId, geometry::Pose3> poses() const;
  const geometry::Pose3& pose(NodeId id) const;  ///< \throws std::invalid_argument

  /// In the order of addition, with residuals at the solution of the last optimise().
  const std::vector<Edge>& edges() const { return edges_; }
  const std::vector<Fix>& fixes() const { return fixes_; }
  const std::vector<Level>& levels() const { return levels_; }

  bool is_georeferenced() const { return is_georeferenced_; }
  /// Up in the map frame; nothing without gravity or ENU.
  std::optional<Eigen::Vector3d> up_map() const;
  /// What all measured ups are off by, body frame, of a unit vector.
  const Eigen::Vector3d& up_offset() const { return up_offset_; }

 private:
  std::size_t index(NodeId id) const;
  /// A node's pose from that of another, by their guesses.
  void place(std::size_t node, std::size_t beside);
  void find_up();
  /// Fixes that are spread out turn the whole graph into ENU, once.
  void georeference();
  void forget_solution();
  /// Residuals, chi-squares and weights at the present poses; returns half the robust sum.
  double evaluate();

  GraphOptions options_;
  std::map<NodeId, std::size_t> index_of_;
  std::vector<NodeId> ids_;
  std::vector<geometry::Pose3> guesses_;  ///< as given
  std::vector<geometry::Pose3> poses_;    ///< T_map_body, the present solution
  std::vector<Edge> edges_;
  std::vector<Fix> fixes_;
  std::vector<Level> levels_;
  std::size_t solved_nodes_ = 0;  ///< how many the last solution has
  std::size_t judged_edges_ = 0;  ///< how many it has given a weight
  std::size_t judged_fixes_ = 0;
  std::size_t judged_levels_ = 0;
  Eigen::Vector3d up_map_ = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d up_offset_ = Eigen::Vector3d::Zero();
  bool is_georeferenced_ = false;
};

}  // namespace traverse::pose_graph
