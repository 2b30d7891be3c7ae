#include "smoother/fixed_lag_smoother.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "traverse/geometry/angle.hpp"

namespace traverse::inertial {

namespace {

using Matrix = NavState::Matrix;
using Cholesky = Eigen::LLT<Matrix>;

/// Informations of 1e-2 to 1e12 stand in one matrix: what a Schur complement loses in rounding may
/// be all that a weak unknown has. A share of each unknown's own information, so small that it is
/// rounding too, then stands in for it.
Cholesky factorised(const Matrix& H) {
  constexpr double kRounding = 1e-14;  // of a double, 22 products and their sum
  constexpr double kMost = 1e-8;
  Cholesky llt(H);
  for (double share = kRounding; llt.info() != Eigen::Success && share <= kMost; share *= 10) {
    Matrix loaded = H;
    loaded.diagonal() += share * H.diagonal().cwiseAbs();
    llt.compute(loaded);
  }
  if (llt.info() != Eigen::Success || !llt.matrixLLT().allFinite()) throw NotSolvable();
  return llt;
}

Matrix symmetric(const Matrix& H) { return 0.5 * (H + H.transpose()); }

/// What the sum over samples is not exact to; keeps links of a few milliseconds from being so stiff
/// that the rest of the information is lost in rounding.
constexpr double kIntegrationRotation = 1e-6;  // rad
constexpr double kIntegrationVelocity = 1e-5;  // m/s
constexpr double kIntegrationPosition = 1e-5;  // m

Preintegration::Matrix9 weight_of(const Preintegration& imu) {
  Preintegration::Matrix9 covariance = imu.covariance();
  covariance.diagonal().segment<3>(0).array() += kIntegrationRotation * kIntegrationRotation;
  covariance.diagonal().segment<3>(3).array() += kIntegrationVelocity * kIntegrationVelocity;
  covariance.diagonal().segment<3>(6).array() += kIntegrationPosition * kIntegrationPosition;
  return square_root_information<9>(covariance);
}

}  // namespace

CalibrationWalk calibration_walk(const NavigationOptions& options) {
  const GnssOptions& gnss = options.gnss;
  return {options.wheels.scale_walk,
          geometry::kDegree * options.wheels.turn_walk_deg,
          gnss.latency_walk,
          {gnss.bias_horizontal_m, gnss.bias_horizontal_m, gnss.bias_vertical_m},
          gnss.bias_s};
}

FixedLagSmoother::FixedLagSmoother(const WindowOptions& options, const ImuNoise& noise,
                                   const CalibrationWalk& calibration,
                                   const Eigen::Vector3d& gravity_map)
    : options_(options), noise_(noise), calibration_(calibration), gravity_map_(gravity_map) {}

FixedLagSmoother::FixedLagSmoother(const FixedLagSmoother& other)
    : options_(other.options_),
      noise_(other.noise_),
      calibration_(other.calibration_),
      gravity_map_(other.gravity_map_),
      nodes_(other.nodes_),
      prior_(other.prior_),
      information_(other.information_),
      covariance_(other.covariance_) {
  for (Node& node : nodes_) {
    if (node.to_next.imu) {
      node.to_next.imu = std::make_shared<Preintegration>(*node.to_next.imu);
    }
  }
}

void FixedLagSmoother::start(const NavState& state, const Tangent& sigma) {
  nodes_.clear();
  nodes_.emplace_back();
  nodes_.back().x = state;
  prior_ = {state, sigma.cwiseInverse().asDiagonal(), Tangent::Zero()};
  covariance_ = sigma.cwiseAbs2().asDiagonal();
  information_ = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
}

FixedLagSmoother::Link FixedLagSmoother::make_link(std::shared_ptr<Preintegration> imu) const {
  const double root_seconds = std::sqrt(imu->seconds());
  Link link;
  link.weight = weight_of(*imu);
  link.gyro_walk = 1 / (noise_.gyro_bias_walk * root_seconds);
  link.accelerometer_walk = 1 / (noise_.accelerometer_bias_walk * root_seconds);
  link.scale_walk = 1 / (calibration_.wheel_scale * root_seconds);
  link.turn_walk = 1 / (calibration_.wheel_turn * root_seconds);
  link.latency_walk = 1 / (calibration_.gnss_latency * root_seconds);
  link.gnss_decay = std::exp(-imu->seconds() / calibration_.gnss_bias_s);
  const double renewed = std::sqrt(1 - link.gnss_decay * link.gnss_decay);
  link.gnss_walk = (renewed * calibration_.gnss_bias_m).cwiseInverse();
  link.imu = std::move(imu);
  return link;
}

void FixedLagSmoother::append(std::shared_ptr<Preintegration> imu) {
  if (!imu->is_usable()) throw std::invalid_argument("a link needs at least two IMU samples");
  const auto is_too_old = [&] {
    return options_.seconds > 0 && nodes_.size() > 1 &&
           geometry::seconds_between(nodes_.front().x.stamp, nodes_.back().x.stamp) >
               options_.seconds;
  };
  while (nodes_.size() >= static_cast<std::size_t>(options_.states) || is_too_old()) {
    marginalise_oldest();
  }
  Node& last = nodes_.back();
  NavState predicted = imu->predict(last.x, gravity_map_);
  last.to_next = make_link(std::move(imu));
  nodes_.emplace_back();
  nodes_.back().x = predicted;

  LinkTerms terms = link_terms(nodes_.size() - 2);
  const Cholesky llt = factorised(information_ + terms.H_ii);
  information_ = symmetric(terms.H_jj - terms.H_ij.transpose() * llt.solve(terms.H_ij));
  covariance_ = factorised(information_).solve(Matrix::Identity());
}

void FixedLagSmoother::add(std::unique_ptr<StateFactor> factor) {
  nodes_.back().factors.push_back(std::move(factor));
}

void FixedLagSmoother::add_to_last(std::unique_ptr<StateFactor> factor) {
  nodes_[nodes_.size() - 2].factors.push_back(std::move(factor));
}

void FixedLagSmoother::reintegrate_where_biases_moved() {
  for (std::size_t k = 0; k + 1 < nodes_.size(); ++k) {
    Node& node = nodes_[k];
    Preintegration& imu = *node.to_next.imu;
    const bool has_moved =
        (node.x.gyro_bias - imu.gyro_bias()).norm() > options_.reintegrate_gyro ||
        (node.x.accelerometer_bias - imu.accelerometer_bias()).norm() >
            options_.reintegrate_accelerometer;
    if (!has_moved) continue;
    imu.reintegrate(node.x.gyro_bias, node.x.accelerometer_bias);
    node.to_next.weight = weight_of(imu);
  }
}

/// Eliminates the states from the oldest on. \returns the factorised diagonal blocks; rows.back().H
/// is then the information of the newest state alone
std::vector<Cholesky> FixedLagSmoother::eliminate(std::vector<BlockRow>& rows) {
  std::vector<Cholesky> diagonals;
  diagonals.reserve(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    diagonals.push_back(factorised(rows[k].H));
    if (k + 1 == rows.size()) break;
    const Matrix M = diagonals[k].solve(rows[k].to_next);
    rows[k + 1].H.noalias() -= rows[k].to_next.transpose() * M;
    rows[k + 1].g.noalias() -= M.transpose() * rows[k].g;
  }
  return diagonals;
}

/// Moves every state by its Gauss-Newton step. \returns the largest coordinate of a step
double FixedLagSmoother::move(const std::vector<BlockRow>& rows,
                              const std::vector<Cholesky>& diagonals) {
  double largest = 0;
  Tangent step;
  for (std::size_t k = rows.size(); k-- > 0;) {
    Tangent right = -rows[k].g;
    if (k + 1 < rows.size()) right -= rows[k].to_next * step;
    step = diagonals[k].solve(right);
    nodes_[k].x = nodes_[k].x.plus(step);
    largest = std::max(largest, step.lpNorm<Eigen::Infinity>());
  }
  return largest;
}

FixedLagSmoother::Solution FixedLagSmoother::solve() {
  // First-estimate Jacobians are not quite those of the cost, which may therefore rise a little
  // near its minimum; a step has failed when it rises for good.
  constexpr double kMostRise = 1.05;
  constexpr double kMostRiseAtZero = 1;
  constexpr double kFirstDamping = 1e-4;
  Solution solution;
  std::vector<BlockRow> rows;
  double damping = 0;
  while (solution.iterations < options_.iterations) {
    ++solution.iterations;
    const double before = build(rows);
    for (BlockRow& row : rows) row.H.diagonal() *= 1 + damping;
    const std::vector<Cholesky> diagonals = eliminate(rows);
    std::vector<NavState> kept;
    for (const Node& node : nodes_) kept.push_back(node.x);
    const double step = move(rows, diagonals);
    solution.cost = cost();
    const bool has_failed = !(solution.cost <= kMostRise * before + kMostRiseAtZero);
    if (has_failed) {
      for (std::size_t k = 0; k < nodes_.size(); ++k) nodes_[k].x = kept[k];
      damping = damping == 0 ? kFirstDamping : 10 * damping;
      solution.cost = before;
      continue;
    }
    reintegrate_where_biases_moved();
    if (damping == 0) information_ = symmetric(rows.back().H);
    solution.converged = damping == 0 && step < options_.converged_step;
    if (solution.converged) break;
    damping = damping <= kFirstDamping ? 0 : damping / 10;
  }
  if (damping > 0) {  // the last system was not the one that counts
    build(rows);
    eliminate(rows);
    information_ = symmetric(rows.back().H);
  }
  covariance_ = factorised(information_).solve(Matrix::Identity());
  solution.covariance = covariance_;
  solution.reason = solution.converged ? optimization::Termination::kConverged
                                       : optimization::Termination::kIterationLimit;
  return solution;
}

std::vector<NavState::Matrix> FixedLagSmoother::covariances() const {
  std::vector<BlockRow> rows;
  build(rows);
  const std::vector<Cholesky> diagonals = eliminate(rows);
  std::vector<Matrix> result(rows.size());
  for (std::size_t k = rows.size(); k-- > 0;) {
    result[k] = diagonals[k].solve(Matrix::Identity());
    if (k + 1 == rows.size()) continue;
    const Matrix M = diagonals[k].solve(rows[k].to_next);
    result[k] += M * result[k + 1] * M.transpose();
  }
  return result;
}

void FixedLagSmoother::marginalise_oldest() {
  BlockRow oldest{Matrix::Zero(), Matrix::Zero(), Tangent::Zero()};
  add_state_terms(0, oldest);
  const LinkTerms link = link_terms(0);
  const Cholesky llt = factorised(oldest.H + link.H_ii);
  const Matrix H = symmetric(link.H_jj - link.H_ij.transpose() * llt.solve(link.H_ij));
  const Tangent g = link.g_j - link.H_ij.transpose() * llt.solve(oldest.g + link.g_i);
  nodes_.pop_front();

  const Cholesky root = factorised(H);
  Node& next = nodes_.front();
  prior_.at = next.x;
  prior_.weight = root.matrixU();
  prior_.offset = root.matrixL().solve(g);
  next.first_estimate = next.x;
}

}  // namespace traverse::inertial
