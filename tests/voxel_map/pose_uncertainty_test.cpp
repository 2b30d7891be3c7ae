#include "traverse/voxel_map/pose_uncertainty.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace traverse::voxel_map {
namespace {

using lidar::Matrix6;
using lidar::Vector6;

/// A lidar that goes by surfaces which come and go: each is off by something of its own for as long
/// as it is seen, and by what the pose was off when it came. All to first order, at one place.
class PassingSurfaces {
 public:
  PassingSurfaces(unsigned seed, int surfaces, int scans_seen)
      : random_(seed), scans_seen_(scans_seen) {
    for (int k = 0; k < surfaces; ++k) surfaces_.push_back(made(k % scans_seen - scans_seen));
  }

  /// The next scan: its pose's error is where the surfaces have it.
  ScanEvidence next() {
    ScanEvidence evidence;
    Vector6 pulled = Vector6::Zero();
    for (std::size_t k = 0; k < surfaces_.size(); ++k) {
      Surface& s = surfaces_[k];
      if (scan_ - s.since > scans_seen_) s = made(scan_);
      const double noise = 0.3 * gaussian();
      offsets_[k] = s.row.dot(s.inherited) + s.offset + noise;
      evidence.information += s.row * s.row.transpose();
      evidence.aged += (scan_ - s.since + 1) * (s.row * s.row.transpose());
      pulled += offsets_[k] * s.row;
    }
    error_ = evidence.information.llt().solve(pulled);
    for (std::size_t k = 0; k < surfaces_.size(); ++k) {
      const Vector6& row = surfaces_[k].row;
      evidence.pull[surfaces_[k].part] += (row.dot(error_) - offsets_[k]) * row;
      evidence.information_of[surfaces_[k].part] += row * row.transpose();
    }
    ++scan_;
    return evidence;
  }
  const Vector6& error() const { return error_; }

 private:
  struct Surface {
    Vector6 row;
    Vector6 inherited;
    double offset = 0;
    int since = 0;
    std::size_t part = 0;
  };

  double gaussian() { return normal_(random_); }
  Surface made(int since) {
    Surface s;
    for (Eigen::Index k = 0; k < 6; ++k) s.row[k] = gaussian();
    s.inherited = error_;
    s.offset = gaussian();
    s.since = since;
    s.part = next_part_++ % ScanEvidence::kParts;
    return s;
  }

  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  int scans_seen_;
  int scan_ = 0;
  std::size_t next_part_ = 0;
  Vector6 error_ = Vector6::Zero();
  std::vector<Surface> surfaces_;
  std::array<double, 1000> offsets_{};
};

/// Of the normalised squared error at the end, by its six degrees of freedom.
double mean_of_squares(int scans_seen, int scans) {
  constexpr int kDrives = 30;
  double sum = 0;
  for (unsigned drive = 0; drive < kDrives; ++drive) {
    PassingSurfaces surfaces(drive, 256, scans_seen);
    PoseUncertainty told;
    for (int k = 0; k < scans; ++k) {
      told.add(surfaces.next(), geometry::Pose3::identity(), true, Matrix6::Zero(),
               Matrix6::Zero());
    }
    const Matrix6 covariance = told.covariance(geometry::Pose3::identity());
    sum += surfaces.error().dot(covariance.llt().solve(surfaces.error())) / 6;
  }
  return sum / kDrives;
}

// Errors that stay with their surface count in each scan that sees it; were scans taken for
// independent, the squares would come out ten times as large.
TEST(PoseUncertainty, CoversTheDriftOverSurfacesThatComeAndGo) {
  for (const int seen : {5, 20}) {
    const double squares = mean_of_squares(seen, 100);
    EXPECT_GT(squares, 0.7) << seen;
    EXPECT_LT(squares, 2) << seen;
  }
}

TEST(PoseUncertainty, GrowsWithTheWayAndNotWhereNothingEntersTheMap) {
  PassingSurfaces surfaces(7, 400, 10);
  PoseUncertainty told;
  const auto at = geometry::Pose3::identity();
  const auto size = [&] { return told.covariance_of_map(at).trace(); };
  for (int k = 0; k < 100; ++k)
    told.add(surfaces.next(), at, true, Matrix6::Zero(), Matrix6::Zero());
  const double after_100 = size();
  for (int k = 0; k < 300; ++k)
    told.add(surfaces.next(), at, true, Matrix6::Zero(), Matrix6::Zero());
  const double after_400 = size();
  EXPECT_GT(after_400, 1.5 * after_100);
  told.add(surfaces.next(), at, false, Matrix6::Zero(), Matrix6::Zero());
  EXPECT_EQ(size(), after_400);
}

// What the map's twist is off by turns about its origin: a lidar 100 m away swings.
TEST(PoseUncertainty, AnErrorOfAttitudeSwingsWithTheDistance) {
  PoseUncertainty told;
  Matrix6 growth = Matrix6::Zero();
  growth(2, 2) = 1e-6;  // yaw, 1 mrad
  told.add_prediction(growth);
  geometry::Pose3 far;
  far.translation.x() = 100;
  const Matrix6 covariance = told.covariance(far);
  EXPECT_NEAR(covariance(2, 2), 1e-6, 1e-12);
  EXPECT_NEAR(covariance(4, 4), 1e-2, 1e-9);
  EXPECT_NEAR(covariance(3, 3), 0, 1e-12);
}

}  // namespace
}  // namespace traverse::voxel_map
