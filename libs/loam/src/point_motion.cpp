#include "point_motion.hpp"

namespace traverse::loam {

geometry::Pose3 part_of(const geometry::Pose3& T, double fraction) {
  if (fraction == 1) return T;
  return {geometry::exp_so3(fraction * geometry::log_so3(T.rotation)), fraction * T.translation};
}

}  // namespace traverse::loam
