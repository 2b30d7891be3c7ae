// What the factors, links and prior of a FixedLagSmoother add to its cost and normal equations.

#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

#include "residuals/inertial.hpp"
#include "residuals/prior.hpp"
#include "residuals/walk.hpp"
#include "smoother/fixed_lag_smoother.hpp"

namespace traverse::inertial {

namespace {

/// Huber's loss of the squared norm s: its value and its derivative, the weight of the rows.
std::pair<double, double> huber_loss(double s, double k) {
  if (k <= 0 || s <= k * k) return {s, 1};
  const double norm = std::sqrt(s);
  return {2 * k * norm - k * k, k / norm};
}

}  // namespace

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
    PriorResidual{prior_.at}(at, &d);
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
  const InertialResidual inertial{link.imu, gravity_map_};
  Residual<9> r = inertial(at_i, at_j, &Ji, &Jj);
  if (&at_i != &i.x || &at_j != &j.x) r = inertial(i.x, j.x);
  r = (link.weight * r).eval();
  const Jacobian<9> Wi = link.weight.triangularView<Eigen::Lower>() * Ji;
  const Jacobian<9> Wj = link.weight.triangularView<Eigen::Lower>() * Jj;

  LinkTerms terms;
  terms.H_ii.noalias() = Wi.transpose() * Wi;
  terms.H_ij.noalias() = Wi.transpose() * Wj;
  terms.H_jj.noalias() = Wj.transpose() * Wj;
  terms.g_i.noalias() = Wi.transpose() * r;
  terms.g_j.noalias() = Wj.transpose() * r;

  // The walks: r = w (x_j - a x_i), so that each adds (a w)^2 and w^2 to the diagonals.
  constexpr int kWalks = NavState::kTangent - NavState::kGyroBias;
  Eigen::Matrix<double, kWalks, 1> w;
  w << Eigen::Vector3d::Constant(link.gyro_walk),
      Eigen::Vector3d::Constant(link.accelerometer_walk), link.scale_walk,
      Eigen::Vector2d::Constant(link.turn_walk), link.latency_walk, link.gnss_walk;
  Eigen::Matrix<double, kWalks, 1> d;
  d << GyroBiasWalk{}(i.x, j.x), AccelerometerBiasWalk{}(i.x, j.x), WheelScaleWalk{}(i.x, j.x),
      WheelTurnWalk{}(i.x, j.x), GnssLatencyWalk{}(i.x, j.x),
      GnssBiasWalk{link.gnss_decay}(i.x, j.x);
  const Eigen::Matrix<double, kWalks, 1> squares = w.cwiseAbs2();
  Eigen::Matrix<double, kWalks, 1> a = Eigen::Matrix<double, kWalks, 1>::Ones();
  a.tail<3>().setConstant(link.gnss_decay);
  terms.H_ii.diagonal().tail<kWalks>() += squares.cwiseProduct(a.cwiseAbs2());
  terms.H_jj.diagonal().tail<kWalks>() += squares;
  terms.H_ij.diagonal().tail<kWalks>() -= squares.cwiseProduct(a);
  terms.g_i.tail<kWalks>() -= squares.cwiseProduct(a).cwiseProduct(d);
  terms.g_j.tail<kWalks>() += squares.cwiseProduct(d);
  terms.cost = (r.squaredNorm() + w.cwiseProduct(d).squaredNorm()) / 2;
  return terms;
}

Innovation FixedLagSmoother::innovation_of_newest() const {
  const Node& node = nodes_.back();
  std::vector<std::pair<Rows, RowsJacobian>> parts(node.factors.size());
  Eigen::Index size = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    node.factors[k]->evaluate(node.x, parts[k].first, &parts[k].second);
    size += parts[k].first.size();
  }
  if (size == 0) return {};
  Eigen::VectorXd r(size);
  Eigen::MatrixXd J(size, NavState::kTangent);
  Eigen::Index row = 0;
  for (const auto& [part, jacobian] : parts) {
    r.segment(row, part.size()) = part;
    J.middleRows(row, part.size()) = jacobian;
    row += part.size();
  }
  // The rows are in standard deviations of what was measured.
  const Eigen::MatrixXd S = J * covariance_ * J.transpose() + Eigen::MatrixXd::Identity(size, size);
  return {r.dot(S.ldlt().solve(r)), static_cast<int>(size), false};
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
    twice += (link.weight * InertialResidual{link.imu, gravity_map_}(i.x, j)).squaredNorm();
    twice += (link.gyro_walk * GyroBiasWalk{}(i.x, j)).squaredNorm();
    twice += (link.accelerometer_walk * AccelerometerBiasWalk{}(i.x, j)).squaredNorm();
    twice += (link.scale_walk * WheelScaleWalk{}(i.x, j)).squaredNorm();
    twice += (link.turn_walk * WheelTurnWalk{}(i.x, j)).squaredNorm();
    twice += (link.latency_walk * GnssLatencyWalk{}(i.x, j)).squaredNorm();
    twice += link.gnss_walk.cwiseProduct(GnssBiasWalk{link.gnss_decay}(i.x, j)).squaredNorm();
  }
  return twice / 2;
}

}  // namespace traverse::inertial
