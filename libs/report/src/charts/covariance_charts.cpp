#include "charts/covariance_charts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "traverse/geometry/se3.hpp"

#include "charts/chart.hpp"
#include "charts/series.hpp"

namespace traverse::report {

namespace {

constexpr double kNormal95 = 1.96;       // of a normal error on both sides
constexpr double kSquares95_6 = 12.592;  // of chi-square with six degrees of freedom

/// The columns of frames.csv that hold the upper triangle; empty where they are not there.
std::vector<std::vector<double>> covariance_columns(const pipeline::FrameTable& frames) {
  constexpr std::array<const char*, 6> kAxes{"rx", "ry", "rz", "tx", "ty", "tz"};
  std::vector<std::vector<double>> columns;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = i; j < 6; ++j) {
      columns.push_back(frames.column(fmt::format("covariance_{}_{}", kAxes[i], kAxes[j])));
      if (columns.back().empty()) return {};
    }
  }
  return columns;
}

geometry::Matrix6 covariance_at(const std::vector<std::vector<double>>& columns, std::size_t pose) {
  geometry::Matrix6 covariance;
  std::size_t k = 0;
  for (Eigen::Index i = 0; i < 6; ++i) {
    for (Eigen::Index j = i; j < 6; ++j) {
      covariance(i, j) = covariance(j, i) = columns[k++][pose];
    }
  }
  return covariance;
}

}  // namespace

void add_covariance_chart(const RunData& run, Json& charts) {
  const auto columns = covariance_columns(run.frames);
  const auto& matches = run.evaluation.comparison->association.matches;
  const geometry::Trajectory& path = run.odometry ? *run.odometry : run.estimate;
  if (columns.empty() || !run.reference || matches.size() < 2 ||
      path.size() != columns.front().size()) {
    return;
  }
  const geometry::Pose3 from_first = path.pose(matches.front().estimate).inverse();
  const geometry::Pose3 truth_from_first = run.reference->pose(matches.front().reference).inverse();
  std::array<std::vector<double>, 3> errors;
  std::array<std::vector<double>, 3> bands;
  std::vector<std::size_t> poses;
  std::size_t within = 0;
  std::size_t judged = 0;
  for (const evaluation::Match& match : matches) {
    const geometry::Pose3 told = from_first * path.pose(match.estimate);
    const geometry::Pose3 truth = truth_from_first * run.reference->pose(match.reference);
    const geometry::Twist off = geometry::log_se3(told.inverse() * truth);
    const geometry::Matrix6 covariance = covariance_at(columns, match.estimate);
    const Eigen::LLT<geometry::Matrix6> factor(covariance);
    if (factor.info() == Eigen::Success) {
      ++judged;
      within += off.dot(factor.solve(off)) <= kSquares95_6 ? 1 : 0;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<Eigen::Index>(3 + axis);
      errors[axis].push_back(-off[k]);
      bands[axis].push_back(kNormal95 * std::sqrt(std::max(0.0, covariance(k, k))));
    }
    poses.push_back(match.estimate);
  }
  if (judged == 0) return;
  Chart chart("pose-bounds", "error",
              fmt::format("Error from the first pose in the body's axes, with the run's own 95 % "
                          "bounds: {:.1f} % of the poses are within them",
                          100 * static_cast<double>(within) / static_cast<double>(judged)),
              "m");
  constexpr std::array<const char*, 3> kNames{"ahead", "left", "up"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    chart.series(kNames[axis], errors[axis], bands[axis]);
  }
  charts.push_back(chart.poses(poses).take());
}

}  // namespace traverse::report
