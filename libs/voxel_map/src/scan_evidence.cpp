#include "traverse/voxel_map/scan_evidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "traverse/voxel_map/local_points.hpp"

#include "point_hash.hpp"

namespace traverse::voxel_map {

namespace {

using Eigen::Vector3d;

/// Planes of one cell, or of the wider one that answers for its neighbours, err alike.
constexpr double kBlock_m = 3;

constexpr auto kLastPart = static_cast<int>(ScanEvidence::kParts) - 1;

std::size_t block_of(const Vector3d& p_map) {
  std::uint32_t mixed = 0;
  constexpr std::uint32_t kFactors[3] = {73856093U, 19349663U, 83492791U};
  for (int k = 0; k < 3; ++k) {
    const auto block = static_cast<std::int32_t>(std::floor(p_map[k] / kBlock_m));
    mixed ^= static_cast<std::uint32_t>(block) * kFactors[k];
  }
  static_assert(ScanEvidence::kParts == 32);
  return spread(mixed) >> 27U;
}

/// Of equal parts of `span` about 0.
std::size_t part_of_span(double value, double span) {
  const int part = static_cast<int>(std::floor((value / span + 0.5) * ScanEvidence::kParts));
  return static_cast<std::size_t>(std::clamp(part, 0, kLastPart));
}

using Parts = std::array<std::size_t, ScanEvidence::kWays>;

/// Rows of the matches at a pose.
class EvidenceSum {
 public:
  EvidenceSum(const ScanMatches& matches, const MotionModel& motion,
              const geometry::Pose3& T_map_lidar)
      : T_map_lidar_(T_map_lidar),
        origin_map_(matches.origin_map),
        swept_(motion.velocity_at(T_map_lidar)) {}

  /// A row's point seen from the lidar, in the axes of the map.
  Vector3d lever(const PlaneRows& rows, std::size_t i) const {
    float x = rows.x[i];
    float y = rows.y[i];
    float z = rows.z[i];
    swept_.apply(rows.time[i], x, y, z);
    return T_map_lidar_.rotation * Vector3d(x, y, z);
  }
  static Vector3d normal(const PlaneRows& rows, std::size_t i) {
    return {rows.nx[i], rows.ny[i], rows.nz[i]};
  }
  double residual(const PlaneRows& rows, std::size_t i, const Vector3d& m) const {
    return normal(rows, i).dot(T_map_lidar_.translation + m - origin_map_) + rows.d[i];
  }
  /// Which pulls a point counts for. \param m  seen from the lidar, in the axes of the map
  Parts parts(const Vector3d& m) const {
    constexpr double kElevations = 0.9;  // rad; what is beyond is of the outermost
    const Vector3d p = T_map_lidar_.rotation.transpose() * m;
    const double azimuth = std::atan2(p.y(), p.x());
    const double elevation = std::atan2(p.z(), std::hypot(p.x(), p.y()));
    return {block_of(T_map_lidar_.translation + m),
            ScanEvidence::kParts + part_of_span(azimuth, 2 * std::numbers::pi),
            2 * ScanEvidence::kParts + part_of_span(elevation, kElevations)};
  }

  void add(const PlaneRows& rows, std::size_t i, const Vector3d& m, const Parts& among, double r,
           double weight) {
    const Vector3d n = normal(rows, i);
    const Vector3d turning = m.cross(n);
    const std::array<double, 6> J{turning.x(), turning.y(), turning.z(), n.x(), n.y(), n.z()};
    const double age = std::max(1.0, static_cast<double>(rows.age[i]));
    Triangle information;
    std::size_t k = 0;
    for (std::size_t row_of_J = 0; row_of_J < 6; ++row_of_J) {
      const double wJ = weight * J[row_of_J];
      for (std::size_t col = row_of_J; col < 6; ++col) information[k++] = wJ * J[col];
    }
    for (k = 0; k < information.size(); ++k) aged_[k] += age * information[k];
    const double pull = weight * r;
    for (const std::size_t part : among) {
      Triangle& of_part = information_of_[part];
      for (k = 0; k < information.size(); ++k) of_part[k] += information[k];
      for (std::size_t axis = 0; axis < 6; ++axis) {
        sum_.pull[part][static_cast<Eigen::Index>(axis)] += pull * J[axis];
      }
    }
  }

  ScanEvidence sum() const {
    ScanEvidence sum = sum_;
    sum.aged = unpacked(aged_);
    for (std::size_t part = 0; part < information_of_.size(); ++part) {
      sum.information_of[part] = unpacked(information_of_[part]);
      if (part < ScanEvidence::kParts) sum.information += sum.information_of[part];
    }
    return sum;
  }

 private:
  /// The upper one of a symmetric matrix, by rows.
  using Triangle = std::array<double, 21>;
  static lidar::Matrix6 unpacked(const Triangle& triangle) {
    lidar::Matrix6 matrix;
    std::size_t k = 0;
    for (Eigen::Index row = 0; row < 6; ++row) {
      for (Eigen::Index col = row; col < 6; ++col) {
        matrix(row, col) = matrix(col, row) = triangle[k++];
      }
    }
    return matrix;
  }

  geometry::Pose3 T_map_lidar_;
  Vector3d origin_map_;
  SweepMotion swept_;
  ScanEvidence sum_;  // the pulls of it
  Triangle aged_{};
  std::array<Triangle, ScanEvidence::kAllParts> information_of_{};
};

}  // namespace

void ScanEvidence::scale(double factor) {
  information *= factor;
  aged *= factor;
  for (lidar::Vector6& one : pull) one *= factor;
  for (lidar::Matrix6& one : information_of) one *= factor;
}

void ScanEvidence::keep(const lidar::Matrix6& root, const lidar::Matrix6& shares) {
  information = (root.transpose() * information * root).eval();
  aged = (root.transpose() * aged * root).eval();
  for (lidar::Vector6& one : pull) one = (shares.transpose() * one).eval();
  for (lidar::Matrix6& one : information_of) one = (root.transpose() * one * root).eval();
}

ScanEvidence scan_evidence(const ScanMatches& matches, const MotionModel& motion,
                           const geometry::Pose3& T_map_lidar, const ObjectiveOptions& options) {
  EvidenceSum sum(matches, motion, T_map_lidar);
  const double k = options.kernel * std::max(matches.scale, options.min_scale);
  const auto robust = [&](double e2) {
    const double u = k * k / (k * k + e2);
    return u * u;
  };
  for (std::size_t i = 0; i < matches.planes.size(); ++i) {
    const PlaneRows& rows = matches.planes;
    const Vector3d m = sum.lever(rows, i);
    const double r = sum.residual(rows, i, m);
    const double w = rows.weight[i];
    sum.add(rows, i, m, sum.parts(m), r, w * robust(r * r * w));
  }
  for (std::size_t i = 0; i < matches.line_1.size(); ++i) {
    const Vector3d m = sum.lever(matches.line_1, i);
    const double r1 = sum.residual(matches.line_1, i, m);
    const double r2 = sum.residual(matches.line_2, i, m);
    const double w = matches.line_1.weight[i];
    const double weight = options.line_weight * w * robust((r1 * r1 + r2 * r2) * w);
    const Parts parts = sum.parts(m);
    sum.add(matches.line_1, i, m, parts, r1, weight);
    sum.add(matches.line_2, i, m, parts, r2, weight);
  }
  return sum.sum();
}

}  // namespace traverse::voxel_map
