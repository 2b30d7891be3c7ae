#include "recording/gga_quality_fact.hpp"

#include <cmath>

#include <fmt/format.h>

#include "traverse/sensors/gga_quality.hpp"

#include "recording/note_once.hpp"

namespace traverse::dataset {

void note_gga_quality(const Eigen::Matrix3d& covariance_enu, std::vector<Fact>& facts) {
  note_once(
      {fmt::format("sigma of fixes of GGA quality {}", sensors::gga_quality_of(covariance_enu)),
       fmt::format("{:g} m horizontally, {:g} m vertically", std::sqrt(covariance_enu(0, 0)),
                   std::sqrt(covariance_enu(2, 2))),
       "the quality code: the fixes tell no deviation themselves"},
      facts);
}

}  // namespace traverse::dataset
