#include "checks/reference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/SVD>
#include <fmt/format.h>

#include "traverse/geometry/angle.hpp"
#include "traverse/geometry/so3.hpp"
#include "traverse/geometry/umeyama.hpp"
#include "traverse/plausibility/reference_checks.hpp"

#include "comparison/delay.hpp"

namespace traverse::plausibility {

namespace {

using geometry::Pose3;
using geometry::Stamp;
using geometry::Trajectory;

constexpr std::array<CodeMeaning, 5> kReferenceCodes{{
    {"reference_late",
     "Path lengths and turns of the reference against those of the estimate, shifted in time "
     "by up to 30 s: more than 0.02 s away they agree better by three tenths and four "
     "sigma."},
    {"reference_scale",
     "With a scale between them the trajectories agree three times as well, and it "
     "is not 0.8 to 1.25: another unit, or a monocular camera."},
    {"reference_mirrored",
     "With a mirror between them they agree three times as well: the reference is "
     "left-handed."},
    {"reference_inverted",
     "With each pose of the reference inverted they agree three times as well: it "
     "holds T_body_map."},
    {"reference_frame",
     "Positions agree to 5 % of the path, and between the orientations lies one and "
     "the same rotation of more than 30 degrees: the poses of another body, as of a "
     "camera."},
}};

struct Pair {
  Pose3 estimate;
  Pose3 reference;
};

std::vector<Pair> pairs_of(const Trajectory& estimate, const Trajectory& reference) {
  constexpr std::size_t kMaxPairs = 1000;
  constexpr double kLongestGap_s = 1;
  std::vector<Pair> pairs;
  const std::size_t step = estimate.size() / kMaxPairs + 1;
  for (std::size_t i = 0; i < estimate.size(); i += step) {
    const auto pose = reference.at(estimate.stamp(i), kLongestGap_s);
    if (pose) pairs.push_back({estimate.pose(i), *pose});
  }
  return pairs;
}

using Points = std::vector<Eigen::Vector3d>;

/// How well `x` fits on `y`: root mean square of what is left, of the transform itself nothing if
/// the points do not determine it.
struct Fit {
  geometry::Similarity similarity;
  double rms_m = std::numeric_limits<double>::infinity();
};

Fit fit(const Points& x, const Points& y, bool with_scale) {
  Fit result;
  try {
    result.similarity = geometry::umeyama(x, y, with_scale);
  } catch (const geometry::DegenerateAlignment&) {
    return result;
  }
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Pose3& T = result.similarity.T_y_x;
    sum += (result.similarity.scale * (T.rotation * x[i]) + T.translation - y[i]).squaredNorm();
  }
  result.rms_m = std::sqrt(sum / static_cast<double>(x.size()));
  return result;
}

double length_of(const Points& points) {
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  return length;
}

/// Standard deviation across the line along which points lie: the rotation about a straight path is
/// not told by it.
double width_of(const Points& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) mean += p / static_cast<double>(points.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) {
    covariance += (p - mean) * (p - mean).transpose() / static_cast<double>(points.size());
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance);
  return std::sqrt(svd.singularValues()[1]);
}

/// Whether the reference tells orientations: receivers write one and the same.
bool turns(const std::vector<Pair>& pairs) {
  constexpr double kSame = geometry::kDegree;
  return std::any_of(pairs.begin(), pairs.end(), [&](const Pair& pair) {
    return geometry::angle_of(pairs.front().reference.rotation.transpose() *
                              pair.reference.rotation) > kSame;
  });
}

/// How far it went and how much it turned, whichever way: neither depends on a frame.
struct MotionOfPath {
  Accumulated<1> length;
  Accumulated<1> turn;
};

MotionOfPath motion_of(const Trajectory& path, Stamp origin) {
  constexpr double kGap_s = 3;
  MotionOfPath motion;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double t = geometry::seconds_between(origin, path.stamp(i));
    double step = 0;
    double turn = 0;
    bool is_gap = false;
    if (i > 0) {
      const Pose3& before = path.pose(i - 1);
      step = (path.pose(i).translation - before.translation).norm();
      turn = geometry::angle_of(before.rotation.transpose() * path.pose(i).rotation);
      is_gap = geometry::seconds_between(path.stamp(i - 1), path.stamp(i)) > kGap_s;
    }
    motion.length.add(t, Accumulated<1>::Vector(step), is_gap);
    motion.turn.add(t, Accumulated<1>::Vector(turn), is_gap);
  }
  return motion;
}

std::optional<Delay> reference_delay(const Accumulated<1>& estimate,
                                     const Accumulated<1>& reference) {
  constexpr double kPiece_s = 1;
  constexpr double kFarthest_s = 30;
  if (estimate.empty() || reference.empty()) return std::nullopt;
  const MotionSource source{"the estimate", [&](double t0, double t1) -> std::optional<double> {
                              const auto amount = estimate.between(t0, t1);
                              return amount ? std::optional((*amount)[0]) : std::nullopt;
                            }};
  std::vector<TimedPiece> pieces;
  for (double t = reference.begin_s(); t + kPiece_s <= reference.end_s(); t += kPiece_s) {
    const auto amount = reference.between(t, t + kPiece_s);
    if (amount) pieces.push_back({t, t + kPiece_s, (*amount)[0]});
  }
  return find_delay(pieces, source, kFarthest_s);
}

std::optional<Finding> look_at_clock(const Trajectory& estimate, const Trajectory& reference) {
  constexpr double kMinDelay_s = 0.02;
  const MotionOfPath driven = motion_of(estimate, estimate.stamp(0));
  const MotionOfPath told = motion_of(reference, estimate.stamp(0));
  std::optional<Delay> best;
  for (const auto& delay :
       {reference_delay(driven.length, told.length), reference_delay(driven.turn, told.turn)}) {
    if (!delay || !delay->is_marked(kMinDelay_s)) continue;
    if (!best || delay->gain_sigmas > best->gain_sigmas) best = delay;
  }
  if (!best) return std::nullopt;
  return Finding{
      "reference_late",
      Severity::kWarn,
      {},
      fmt::format("the reference's motion goes best with the estimate's as that of {:.3f} s {} its "
                  "stamps: the mean difference is then {:.1f} %, else {:.1f} %",
                  std::abs(best->seconds), best->seconds > 0 ? "before" : "after",
                  100 * best->there.mean, 100 * best->at_zero.mean),
      fmt::format("At 10 m/s every pose would be compared with one {:.2f} m away",
                  10 * std::abs(best->seconds)),
      fmt::format("`traverse evaluate ... --time-offset {:.3f}`", best->seconds)};
}

std::optional<Finding> look_at_shape(const std::vector<Pair>& pairs) {
  constexpr double kMuchBetter = 1.0 / 3;
  Points estimate, mirrored, reference, inverted;
  for (const Pair& pair : pairs) {
    const Eigen::Vector3d& p = pair.estimate.translation;
    estimate.push_back(p);
    mirrored.emplace_back(p.x(), -p.y(), p.z());
    reference.push_back(pair.reference.translation);
    inverted.push_back(pair.reference.inverse().translation);
  }
  const double length = length_of(estimate);
  const Fit plain = fit(estimate, reference, false);
  // What fits to a fiftieth of its length is of the same shape.
  if (!std::isfinite(plain.rms_m) || plain.rms_m < 0.02 * length) return std::nullopt;
  const Fit scaled = fit(estimate, reference, true);
  const bool is_scale = scaled.rms_m < kMuchBetter * plain.rms_m &&
                        (scaled.similarity.scale < 0.8 || scaled.similarity.scale > 1.25);
  if (is_scale) {
    return Finding{
        "reference_scale",
        Severity::kWarn,
        {},
        fmt::format("the reference is {:.4g} times as large as the estimate; so scaled they "
                    "are {:.2f} m apart, else {:.2f} m",
                    scaled.similarity.scale, scaled.rms_m, plain.rms_m),
        "Every figure of accuracy would tell of the unit alone",
        {}};
  }
  if (fit(mirrored, reference, false).rms_m < kMuchBetter * plain.rms_m) {
    return Finding{
        "reference_mirrored",
        Severity::kWarn,
        {},
        fmt::format("the reference is the mirror image of the estimate: mirrored they are "
                    "{:.2f} m apart, else {:.2f} m",
                    fit(mirrored, reference, false).rms_m, plain.rms_m),
        "Its axes are left-handed; no rotation aligns it",
        {}};
  }
  if (fit(estimate, inverted, false).rms_m < kMuchBetter * plain.rms_m) {
    return Finding{
        "reference_inverted",
        Severity::kWarn,
        {},
        fmt::format("the reference's poses agree with the estimate's once they are inverted: "
                    "{:.2f} m apart, else {:.2f} m",
                    fit(estimate, inverted, false).rms_m, plain.rms_m),
        "It holds the map in the body's frame, not the body in the map's",
        {}};
  }
  return std::nullopt;
}

std::optional<Finding> look_at_axes(const std::vector<Pair>& pairs) {
  constexpr double kMinAngle = 30 * geometry::kDegree;
  Points estimate, reference;
  for (const Pair& pair : pairs) {
    estimate.push_back(pair.estimate.translation);
    reference.push_back(pair.reference.translation);
  }
  const Fit aligned = fit(estimate, reference, false);
  if (!(aligned.rms_m < 0.05 * length_of(estimate))) return std::nullopt;
  if (width_of(estimate) < 5 * aligned.rms_m || !turns(pairs)) return std::nullopt;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Pair& pair : pairs) {
    sum += (aligned.similarity.T_y_x.rotation * pair.estimate.rotation).transpose() *
           pair.reference.rotation;
  }
  // The mean of rotations that are all the same has three singular values of their number.
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double agreement = svd.singularValues().sum() / (3.0 * static_cast<double>(pairs.size()));
  const Eigen::Matrix3d R_body_other = svd.matrixU() * svd.matrixV().transpose();
  const double angle = geometry::angle_of(R_body_other);
  if (agreement < 0.95 || R_body_other.determinant() < 0 || angle < kMinAngle) return std::nullopt;
  Eigen::Matrix3d R_body_camera;  // z ahead, x right, y down
  R_body_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const bool is_camera =
      geometry::angle_of(R_body_camera.transpose() * R_body_other) < 15 * geometry::kDegree;
  return Finding{
      "reference_frame",
      Severity::kWarn,
      {},
      fmt::format("the reference's orientations are all rotated by {:.0f} deg from the "
                  "estimate's, about ({:.2f}, {:.2f}, {:.2f}) of the body{}",
                  angle / geometry::kDegree, geometry::log_so3(R_body_other).normalized().x(),
                  geometry::log_so3(R_body_other).normalized().y(),
                  geometry::log_so3(R_body_other).normalized().z(),
                  is_camera ? ", as a camera's axes are (z ahead, x right)" : ""),
      "Rotation errors would tell of its axes alone",
      is_camera ? "--reference-frame camera (with a calibration)" : ""};
}

}  // namespace

std::span<const CodeMeaning> reference_codes() { return kReferenceCodes; }

std::vector<Finding> reference_findings(const Trajectory& estimate, const Trajectory& reference) {
  constexpr std::size_t kMinPairs = 10;
  constexpr double kMinLength_m = 2;
  std::vector<Finding> findings;
  if (estimate.empty() || !estimate.is_stamped() || !reference.is_stamped()) return findings;
  if (estimate.path_length() < kMinLength_m) return findings;
  const bool is_ordered = std::is_sorted(reference.stamps().begin(), reference.stamps().end());
  if (!is_ordered) return findings;
  if (auto late = look_at_clock(estimate, reference)) findings.push_back(std::move(*late));
  const std::vector<Pair> pairs = pairs_of(estimate, reference);
  if (pairs.size() < kMinPairs) return findings;
  if (auto shape = look_at_shape(pairs)) {
    findings.push_back(std::move(*shape));
  } else if (auto axes = look_at_axes(pairs)) {
    findings.push_back(std::move(*axes));
  }
  return findings;
}

}  // namespace traverse::plausibility
