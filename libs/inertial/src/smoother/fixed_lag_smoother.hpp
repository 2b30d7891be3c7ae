#pragma once

#include <array>
#include <deque>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "traverse/inertial/navigation_options.hpp"
#include "traverse/optimization/termination.hpp"

#include "factors/innovation.hpp"
#include "factors/preintegration.hpp"
#include "factors/state_factor.hpp"

namespace traverse::inertial {

/// The normal equations tell nothing of an unknown, or are not finite.
class NotSolvable : public std::runtime_error {
 public:
  NotSolvable()
      : std::runtime_error(
            "navigation: the states cannot be solved for, their information is not positive "
            "definite") {}
};

/// How fast what should be constant may change, standard deviation a sqrt(s), and how the bias of
/// fixes comes and goes.
struct CalibrationWalk {
  double wheel_scale;
  double wheel_turn;            ///< rad
  double gnss_latency;          ///< s
  Eigen::Vector3d gnss_bias_m;  ///< standard deviations for good
  double gnss_bias_s;           ///< time after which a share of 1/e is left
};

CalibrationWalk calibration_walk(const NavigationOptions& options);

/// The states of the last moments as a chain: each is linked to the next by what the IMU measured
/// between them and by the walk of its biases, each may have factors of its own, and the oldest has
/// a prior in which all that is older is kept.
///
/// The normal equations of a chain are block-tridiagonal. Eliminating its states from the oldest on
/// is both the solution (Gauss-Newton, damped when a step fails) and, stopped after the first
/// state, its marginalisation: the Schur complement with its gradient, at the point of
/// linearisation, becomes the prior of the second. With first-estimate Jacobians, factors that
/// touch the oldest state are then derived at that point for good (Huang, Mourikis and Roumeliotis,
/// "Analysis and improvement of the consistency of extended Kalman filter based SLAM", ICRA 2008).
class FixedLagSmoother {
 public:
  struct Solution {
    /// The last step, undamped, moved no unknown by converged_step or more.
    bool converged = false;
    optimization::Termination reason = optimization::Termination::kNotRun;
    int iterations = 0;
    double cost = 0;  ///< half the sum of squares, robust
    /// Of the newest state, with all its factors, in its tangent (NavState::Part): rotation on the
    /// right [rad, body] first, then position [m], velocity [m/s], ... in the map frame.
    NavState::Matrix covariance = NavState::Matrix::Zero();
  };

  FixedLagSmoother(const WindowOptions& options, const ImuNoise& noise,
                   const CalibrationWalk& calibration, const Eigen::Vector3d& gravity_map);

  /// A copy has pre-integrations of its own, because they are made again when biases move.
  FixedLagSmoother(const FixedLagSmoother& other);
  FixedLagSmoother(FixedLagSmoother&&) = default;
  FixedLagSmoother& operator=(const FixedLagSmoother&) = delete;
  FixedLagSmoother& operator=(FixedLagSmoother&&) = default;

  /// \param sigma  standard deviations of the tangent
  void start(const NavState& state, const NavState::Tangent& sigma);

  /// Adds the state that `imu` leads to from the newest one; the oldest is marginalised when there
  /// are too many. \throws std::invalid_argument if imu is not usable
  void append(std::shared_ptr<Preintegration> imu);
  /// Constrains the newest state.
  void add(std::unique_ptr<StateFactor> factor);
  /// Constrains the state before the newest. \pre size() > 1
  void add_to_last(std::unique_ptr<StateFactor> factor);

  /// Of the newest state as it was predicted against all factors that constrain it together: what
  /// is to be asked between append() and solve(). No rows where nothing constrains it.
  Innovation innovation_of_newest() const;

  /// \throws NotSolvable if the normal equations are not positive definite
  Solution solve();

  std::size_t size() const { return nodes_.size(); }
  /// Whether append() will marginalise the oldest state, or may.
  bool is_full() const {
    return options_.seconds > 0 || nodes_.size() >= static_cast<std::size_t>(options_.states);
  }
  const NavState& newest() const { return nodes_.back().x; }
  const NavState& state(std::size_t k) const { return nodes_[k].x; }
  /// Of the newest state: after solve() with its factors, after append() without any.
  const NavState::Matrix& covariance() const { return covariance_; }
  /// Of every state, by what the whole window knows; after solve().
  std::vector<NavState::Matrix> covariances() const;

 private:
  using Matrix = NavState::Matrix;
  using Tangent = NavState::Tangent;

  struct Link {
    std::shared_ptr<Preintegration> imu;
    Preintegration::Matrix9 weight;
    double gyro_walk = 0;  ///< 1 / standard deviation
    double accelerometer_walk = 0;
    double scale_walk = 0;
    double turn_walk = 0;
    double latency_walk = 0;
    Eigen::Vector3d gnss_walk = Eigen::Vector3d::Zero();
    double gnss_decay = 1;
  };
  struct Node {
    NavState x;
    std::optional<NavState> first_estimate;  ///< where Jacobians are taken, if not at x
    std::vector<std::shared_ptr<const StateFactor>> factors;
    Link to_next;
  };
  /// r = W (x - at) + e
  struct Prior {
    NavState at;
    Matrix weight;
    Tangent offset;
  };
  /// One block row of the normal equations H d = -g, and its coupling with the next state.
  struct BlockRow {
    Matrix H;
    Matrix to_next;
    Tangent g;
  };
  struct LinkTerms {
    Matrix H_ii, H_ij, H_jj;
    Tangent g_i, g_j;
    double cost = 0;
  };

  Link make_link(std::shared_ptr<Preintegration> imu) const;
  void reintegrate_where_biases_moved();
  double add_state_terms(std::size_t k, BlockRow& row) const;
  LinkTerms link_terms(std::size_t k) const;
  double cost() const;
  double build(std::vector<BlockRow>& rows) const;
  static std::vector<Eigen::LLT<Matrix>> eliminate(std::vector<BlockRow>& rows);
  double move(const std::vector<BlockRow>& rows, const std::vector<Eigen::LLT<Matrix>>& diagonals);
  void marginalise_oldest();
  const NavState& derived_at(const Node& node) const;

  WindowOptions options_;
  ImuNoise noise_;
  CalibrationWalk calibration_;
  Eigen::Vector3d gravity_map_;
  std::deque<Node> nodes_;
  Prior prior_;
  Matrix information_;  ///< of the newest state
  Matrix covariance_;
};

}  // namespace traverse::inertial
