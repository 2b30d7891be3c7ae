#pragma once

#include <vector>

#include <Eigen/Core>

#include "traverse/dataset/source.hpp"

namespace traverse::dataset {

/// Says once a code in `facts` what its fixes are taken to err by: GGA's quality code is all that
/// told it. \param covariance_enu  sensors::covariance_of_gga_quality() of that code [m^2]
void note_gga_quality(const Eigen::Matrix3d& covariance_enu, std::vector<Fact>& facts);

}  // namespace traverse::dataset
