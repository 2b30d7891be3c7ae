#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "traverse/geometry/pose3.hpp"
#include "traverse/geometry/se3.hpp"
#include "traverse/geometry/stamp.hpp"

namespace traverse::slam {

/// What made two keyframes look like one place.
enum class LoopSource : std::uint8_t { kPosition, kAppearance };

/// What became of a candidate, in the order of the checks.
enum class LoopVerdict : std::uint8_t {
  kAccepted,
  kNotRegistered,  ///< too few matches, or the solver failed
  kDegenerate,     ///< the scan does not determine all six directions in the submap
  kLittleOverlap,  ///< too few of the scan's points lie on the submap
  kResidual,       ///< those that do lie off its planes and lines
  kOdometry,       ///< contradicts odometry within its covariance
  kAlone,          ///< no loop nearby agrees with it, and odometry cannot confirm it
  kOutvoted,       ///< lost its weight in the pose graph
};
std::string_view name_of(LoopSource source);
std::string_view name_of(LoopVerdict verdict);

/// A candidate and how its verification went.
struct Loop {
  std::size_t keyframe = 0;   ///< the later one
  std::size_t candidate = 0;  ///< the earlier one, whose surroundings it was registered in
  geometry::Stamp stamp;      ///< of the keyframe
  geometry::Stamp candidate_stamp;
  LoopSource source = LoopSource::kPosition;
  LoopVerdict verdict = LoopVerdict::kNotRegistered;

  geometry::Pose3 T_candidate_keyframe;  ///< by registration; the prediction where that failed
  /// Of (rotation on the right, translation): as PoseGraph::add_between takes it.
  geometry::Matrix6 covariance = geometry::Matrix6::Zero();
  double overlap = 0;         ///< share of the scan's points that lie on the submap
  double submap_overlap = 1;  ///< the share that the submap's own centre reaches
  double residual_rms_m = 0;
  double weakest_eigenvalue = 0;   ///< of the information a match
  double odometry_chi2 = 0;        ///< of the difference to odometry's prediction, 6 d.o.f.
  double prediction_sigma_m = 0;   ///< of that prediction's position, the largest axis
  double correction_m = 0;         ///< from the prediction
  double descriptor_distance = 1;  ///< of the two Scan Contexts
  double graph_chi2 = 0;           ///< in the final graph, of accepted ones
  double weight = 0;               ///< in the final graph

  bool is_accepted() const { return verdict == LoopVerdict::kAccepted; }
};

/// loops.csv, one row a candidate. \throws files::OutputError
void write_loops(const std::filesystem::path& file, std::span<const Loop> loops);
/// \throws files::InputError naming the line. Covariances are not in the file.
std::vector<Loop> read_loops(const std::filesystem::path& file);

}  // namespace traverse::slam
