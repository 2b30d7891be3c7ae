#include "odometry_sums.hpp"

#include <Eigen/Dense>

#include "traverse/geometry/se3.hpp"

namespace traverse::pose_graph {

using geometry::adjoint;
using geometry::Matrix6;
using geometry::Pose3;

OdometrySums::OdometrySums(const GraphParts& graph) {
  const std::vector<const Edge*> steps = steps_of(graph);
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const Edge* step = steps[k];
    if (step == nullptr) {
      chain_.push_back(k);
      T_chain_node_.push_back(Pose3::identity());
      covariances_.push_back(Matrix6::Zero());
      continue;
    }
    chain_.push_back(chain_.back());
    T_chain_node_.push_back((T_chain_node_.back() * step->T_i_j).orthonormalised());
    const Matrix6 to_chain = adjoint(T_chain_node_.back());
    const Matrix6 twist = MeasuredMotion{step->T_i_j, step->covariance}.twist_covariance();
    covariances_.push_back(covariances_.back() + to_chain * twist * to_chain.transpose());
  }
}

Pose3 OdometrySums::motion(std::size_t i, std::size_t j) const {
  return T_chain_node_[i].inverse() * T_chain_node_[j];
}

Matrix6 OdometrySums::covariance(std::size_t i, std::size_t j) const {
  const Matrix6 from_chain = adjoint(T_chain_node_[j].inverse());
  const Matrix6 sum = i < j ? Matrix6(covariances_[j] - covariances_[i])
                            : Matrix6(covariances_[i] - covariances_[j]);
  return from_chain * sum * from_chain.transpose();
}

double OdometrySums::chi2(std::size_t i, std::size_t j, const MeasuredMotion& other) const {
  const geometry::Twist off = geometry::log_se3(motion(i, j).inverse() * other.T_i_j);
  const Matrix6 sum = covariance(i, j) + other.twist_covariance();
  return off.dot(sum.ldlt().solve(off));
}

}  // namespace traverse::pose_graph
