#include "fixed_lag_smoother.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace traverse::inertial {

namespace {

using Matrix = NavState::Matrix;
using Cholesky = Eigen::LLT<Matrix>;

Cholesky factorised(const Matrix& H) {
  Cholesky llt(H);
  if (llt.info() != Eigen::Success) {
    throw std::runtime_error(
        "navigation: the states cannot be solved for, their information is not "
        "positive definite");
  }
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

/// Huber's loss of the squared norm s: its value and its derivative, the weight of the rows.
std::pair<double, double> huber_loss(double s, double k) {
  if (k <= 0 || s <= k * k) return {s, 1};
  const double norm = std::sqrt(s);
  return {2 * k * norm - k * k, k / norm};
}

}  // namespace

CalibrationWalk calibration_walk(const NavigationOptions& options) {
  constexpr double kRadiansPerDegree = std::numbers::pi / 180;
  const GnssOptions& gnss = options.gnss;
  return {options.wheels.scale_walk,
          kRadiansPerDegree * options.wheels.turn_walk_deg,
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

std::vector<FactorType> FixedLagSmoother::factors_of(std::size_t k) const {
  std::vector<FactorType> types;
  for (const auto& factor : nodes_[k].factors) types.push_back(factor->type());
  return types;
}

const NavState& FixedLagSmoother::derived_at(const Node& node) const {
  return node.first_estimate && options_.first_estimate_jacobians ? *node.first_estimate : node.x;
}

double FixedLagSmoother::add_state_terms(std::size_t k, BlockRow& row) const {
  const Node& node = nodes_[k];
  const NavState& at = derived_at(node);
  double twice_cost = 0;
  Rows r;
  RowsJacobian J;
  for (const auto& factor : node.factors) {
    factor->evaluate(at, r, &J);
    if (&at != &node.x) factor->evaluate(node.x, r, nullptr);
    const auto [loss, weight] = huber_loss(r.squaredNorm(), factor->huber);
    row.H.noalias() += weight * J.transpose() * J;
    row.g.noalias() += weight * J.transpose() * r;
    twice_cost += loss;
  }
  if (k == 0) {
    Jacobian<NavState::kTangent> d;
    prior_residual(prior_.at, at, &d);
    const Matrix W = prior_.weight * d;
    const Tangent e = prior_.weight * node.x.minus(prior_.at) + prior_.offset;
    row.H.noalias() += W.transpose() * W;
    row.g.noalias() += W.transpose() * e;
    twice_cost += e.squaredNorm();
  }
  return twice_cost / 2;
}

FixedLagSmoother::LinkTerms FixedLagSmoother::link_terms(std::size_t k) const {
  const Node& i = nodes_[k];
  const Node& j = nodes_[k + 1];
  const Link& link = i.to_next;
  Jacobian<9> Ji;
  Jacobian<9> Jj;
  const NavState& at_i = derived_at(i);
  const NavState& at_j = derived_at(j);
  Residual<9> r = inertial_residual(*link.imu, gravity_map_, at_i, at_j, &Ji, &Jj);
  if (&at_i != &i.x || &at_j != &j.x) r = inertial_residual(*link.imu, gravity_map_, i.x, j.x);
  r = (link.weight * r).eval();
  const Jacobian<9> Wi = link.weight.triangularView<Eigen::Lower>() * Ji;
  const Jacobian<9> Wj = link.weight.triangularView<Eigen::Lower>() * Jj;

  LinkTerms terms;
  terms.H_ii.noalias() = Wi.transpose() * Wi;
  terms.H_ij.noalias() = Wi.transpose() * Wj;
  terms.H_jj.noalias() = Wj.transpose() * Wj;
  terms.g_i.noalias() = Wi.transpose() * r;
  terms.g_j.noalias() = Wj.transpose() * r;
  terms.inertial_chi2 = r.squaredNorm();

  // The walks: r = w (x_j - a x_i), so that each adds (a w)^2 and w^2 to the diagonals.
  constexpr int kWalks = NavState::kTangent - NavState::kGyroBias;
  Eigen::Matrix<double, kWalks, 1> w;
  w << Eigen::Vector3d::Constant(link.gyro_walk),
      Eigen::Vector3d::Constant(link.accelerometer_walk), link.scale_walk,
      Eigen::Vector2d::Constant(link.turn_walk), link.latency_walk, link.gnss_walk;
  Eigen::Matrix<double, kWalks, 1> d;
  d << gyro_bias_walk_residual(i.x, j.x), accelerometer_bias_walk_residual(i.x, j.x),
      wheel_scale_walk_residual(i.x, j.x), wheel_turn_walk_residual(i.x, j.x),
      gnss_latency_walk_residual(i.x, j.x), gnss_bias_walk_residual(link.gnss_decay, i.x, j.x);
  const Eigen::Matrix<double, kWalks, 1> squares = w.cwiseAbs2();
  Eigen::Matrix<double, kWalks, 1> a = Eigen::Matrix<double, kWalks, 1>::Ones();
  a.tail<3>().setConstant(link.gnss_decay);
  terms.H_ii.diagonal().tail<kWalks>() += squares.cwiseProduct(a.cwiseAbs2());
  terms.H_jj.diagonal().tail<kWalks>() += squares;
  terms.H_ij.diagonal().tail<kWalks>() -= squares.cwiseProduct(a);
  terms.g_i.tail<kWalks>() -= squares.cwiseProduct(a).cwiseProduct(d);
  terms.g_j.tail<kWalks>() += squares.cwiseProduct(d);
  terms.cost = (terms.inertial_chi2 + w.cwiseProduct(d).squaredNorm()) / 2;
  return terms;
}

double FixedLagSmoother::build(std::vector<BlockRow>& rows) const {
  rows.resize(nodes_.size());
  double sum = 0;
  for (BlockRow& row : rows) {
    row.H.setZero();
    row.g.setZero();
  }
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    sum += add_state_terms(k, rows[k]);
    if (k + 1 == nodes_.size()) break;
    const LinkTerms terms = link_terms(k);
    rows[k].H += terms.H_ii;
    rows[k].g += terms.g_i;
    rows[k].to_next = terms.H_ij;
    rows[k + 1].H += terms.H_jj;
    rows[k + 1].g += terms.g_j;
    sum += terms.cost;
  }
  return sum;
}

double FixedLagSmoother::cost() const {
  double twice = (prior_.weight * nodes_.front().x.minus(prior_.at) + prior_.offset).squaredNorm();
  Rows r;
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const Node& i = nodes_[k];
    for (const auto& factor : i.factors) {
      factor->evaluate(i.x, r, nullptr);
      twice += huber_loss(r.squaredNorm(), factor->huber).first;
    }
    if (k + 1 == nodes_.size()) break;
    const NavState& j = nodes_[k + 1].x;
    const Link& link = i.to_next;
    twice += (link.weight * inertial_residual(*link.imu, gravity_map_, i.x, j)).squaredNorm();
    twice += (link.gyro_walk * gyro_bias_walk_residual(i.x, j)).squaredNorm();
    twice += (link.accelerometer_walk * accelerometer_bias_walk_residual(i.x, j)).squaredNorm();
    twice += (link.scale_walk * wheel_scale_walk_residual(i.x, j)).squaredNorm();
    twice += (link.turn_walk * wheel_turn_walk_residual(i.x, j)).squaredNorm();
    twice += (link.latency_walk * gnss_latency_walk_residual(i.x, j)).squaredNorm();
    twice +=
        link.gnss_walk.cwiseProduct(gnss_bias_walk_residual(link.gnss_decay, i.x, j)).squaredNorm();
  }
  return twice / 2;
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
    if (damping == 0 && step < options_.converged_step) break;
    damping = damping <= kFirstDamping ? 0 : damping / 10;
  }
  if (damping > 0) {  // the last system was not the one that counts
    build(rows);
    eliminate(rows);
    information_ = symmetric(rows.back().H);
  }
  covariance_ = factorised(information_).solve(Matrix::Identity());
  if (nodes_.size() > 1) solution.inertial_chi2 = link_terms(0).inertial_chi2;
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
