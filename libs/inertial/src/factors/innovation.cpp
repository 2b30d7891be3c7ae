#include "factors/innovation.hpp"

#include <Eigen/Cholesky>

namespace traverse::inertial {

Innovation innovation(const Rows& r, const RowsJacobian& J, const NavState::Matrix& P,
                      const RowsCovariance& R) {
  const RowsCovariance S = J * P * J.transpose() + R;
  return {r.dot(S.ldlt().solve(r)), static_cast<int>(r.size()), false};
}

}  // namespace traverse::inertial
