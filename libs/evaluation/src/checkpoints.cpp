#include "traverse/evaluation/checkpoints.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <fmt/format.h>

#include "traverse/evaluation/evaluation_error.hpp"
#include "traverse/statistics/quantile.hpp"

namespace traverse::evaluation {

namespace {

using geometry::Pose3;
using geometry::Similarity;
using geometry::Trajectory;

/// The mean place of what stood over a point while the vehicle stood there.
std::optional<Eigen::Vector3d> mean_place(const Trajectory& path, geometry::Stamp begin,
                                          geometry::Stamp end, const Eigen::Vector3d& p_body) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path.stamp(i) < begin || path.stamp(i) > end) continue;
    sum += path.pose(i) * p_body;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

/// Where the estimate says that a point is, map frame; nothing, and why in `why`, if it does not.
std::optional<Eigen::Vector3d> place_of(const Checkpoint& point, const Trajectory& path,
                                        const std::vector<Stop>& stops,
                                        const CheckpointOptions& options, std::string& why) {
  if (point.stop > 0) {
    if (point.stop <= stops.size()) {
      const Stop& stop = stops[point.stop - 1];
      return mean_place(path, stop.begin, stop.end, options.p_body);
    }
    why = fmt::format("the trajectory has {} stops of at least 2 s", stops.size());
    return std::nullopt;
  }
  if (point.until) {
    const auto place = mean_place(path, *point.stamp, *point.until, options.p_body);
    if (!place) why = "no pose from then until then";
    return place;
  }
  const auto pose = path.at(*point.stamp, options.max_gap_s);
  if (pose) return *pose * options.p_body;
  why = fmt::format("no poses around {} s, or more than {:g} s apart", to_text(*point.stamp),
                    options.max_gap_s);
  return std::nullopt;
}

/// Weighted figures, where every deviation is told.
void add_weighted(const std::vector<const CheckpointResidual*>& residuals,
                  CheckpointFigures& figures) {
  const auto has_sigmas = [](const CheckpointResidual* one) {
    return (one->point.sigma_m.array() > 0).all();
  };
  if (!std::all_of(residuals.begin(), residuals.end(), has_sigmas)) return;
  double normalised_horizontal = 0;
  double normalised_vertical = 0;
  Eigen::Vector2d sums = Eigen::Vector2d::Zero();  // of weighted squares
  Eigen::Vector2d weights = Eigen::Vector2d::Zero();
  for (const CheckpointResidual* one : residuals) {
    const Eigen::Vector3d& d = one->residual_m;
    const Eigen::Vector3d& sigma = one->point.sigma_m;
    const Eigen::Vector3d ratio = d.cwiseQuotient(sigma);
    normalised_horizontal += ratio.head<2>().squaredNorm() / 2;
    normalised_vertical += ratio.z() * ratio.z();
    const Eigen::Vector2d weight(1 / sigma.head<2>().squaredNorm(), 1 / (sigma.z() * sigma.z()));
    sums += weight.cwiseProduct(Eigen::Vector2d(d.head<2>().squaredNorm(), d.z() * d.z()));
    weights += weight;
  }
  const auto count = static_cast<double>(residuals.size());
  figures.normalised_horizontal = std::sqrt(normalised_horizontal / count);
  figures.normalised_vertical = std::sqrt(normalised_vertical / count);
  figures.weighted_horizontal_m = std::sqrt(sums.x() / weights.x());
  figures.weighted_vertical_m = std::sqrt(sums.y() / weights.y());
}

double weight_of(const Checkpoint& point) {
  const double variance = point.sigma_m.squaredNorm() / 3;
  return variance > 0 ? 1 / variance : 0;
}

/// As geometry::umeyama(), each pair by its weight: the weighted sum of squares is the least.
Similarity weighted_alignment(const std::vector<Eigen::Vector3d>& x,
                              const std::vector<Eigen::Vector3d>& y,
                              const std::vector<double>& weights, bool with_scale) {
  double total = 0;
  Eigen::Vector3d mean_x = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_y = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < x.size(); ++i) {
    total += weights[i];
    mean_x += weights[i] * x[i];
    mean_y += weights[i] * y[i];
  }
  mean_x /= total;
  mean_y /= total;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double variance_x = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    covariance += weights[i] / total * (y[i] - mean_y) * (x[i] - mean_x).transpose();
    variance_x += weights[i] / total * (x[i] - mean_x).squaredNorm();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d& singular = svd.singularValues();
  constexpr double kOnALine = 1e-9;  // of the largest: points to a few millimetres in 100 m
  if (x.size() < 3 || !(singular[1] > kOnALine * singular[0])) {
    throw EvaluationError(fmt::format(
        "expected at least three points that are not on one line to align the estimate by, found "
        "{}{}; --align none takes the estimate as it is",
        x.size(), x.size() < 3 ? "" : " on one line"));
  }
  Eigen::Vector3d signs(1, 1, 1);
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) signs[2] = -1;
  Similarity found;
  found.T_y_x.rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  if (with_scale) found.scale = singular.dot(signs) / variance_x;
  found.T_y_x.translation = mean_y - found.scale * (found.T_y_x.rotation * mean_x);
  return found;
}

CheckpointFigures figures_of(const std::vector<const CheckpointResidual*>& residuals) {
  CheckpointFigures figures;
  figures.count = residuals.size();
  const auto count = static_cast<double>(residuals.size());
  std::vector<double> horizontal;
  std::vector<double> vertical;
  for (const CheckpointResidual* one : residuals) {
    const Eigen::Vector3d& d = one->residual_m;
    figures.rmse_m += d.cwiseAbs2() / count;
    horizontal.push_back(d.head<2>().norm());
    vertical.push_back(std::abs(d.z()));
    const Eigen::Vector3d& sigma = one->point.sigma_m;
    figures.survey_horizontal_m += sigma.head<2>().squaredNorm() / count;
    figures.survey_vertical_m += sigma.z() * sigma.z() / count;
  }
  figures.rmse_horizontal_m = std::sqrt(figures.rmse_m.head<2>().sum());
  figures.rmse_vertical_m = std::sqrt(figures.rmse_m.z());
  figures.rmse_3d_m = std::sqrt(figures.rmse_m.sum());
  figures.rmse_m = figures.rmse_m.cwiseSqrt().eval();
  figures.p95_horizontal_m = statistics::quantile(horizontal, 0.95);
  figures.p95_vertical_m = statistics::quantile(vertical, 0.95);
  figures.survey_horizontal_m = std::sqrt(figures.survey_horizontal_m);
  figures.survey_vertical_m = std::sqrt(figures.survey_vertical_m);
  add_weighted(residuals, figures);
  return figures;
}

std::optional<CheckpointFigures> figures_of_kind(const std::vector<CheckpointResidual>& all,
                                                 bool is_control) {
  std::vector<const CheckpointResidual*> chosen;
  for (const CheckpointResidual& one : all) {
    if (one.point.is_control == is_control) chosen.push_back(&one);
  }
  if (chosen.empty()) return std::nullopt;
  return figures_of(chosen);
}

/// The points that take part in the alignment: control points, or all where there are none.
void align_to_points(const std::vector<std::pair<Checkpoint, Eigen::Vector3d>>& places,
                     CheckpointEvaluation& evaluation) {
  if (evaluation.alignment == AlignmentMode::kNone) return;
  const auto is_control = [](const auto& place) { return place.first.is_control; };
  evaluation.is_by_all = std::none_of(places.begin(), places.end(), is_control);
  std::vector<Eigen::Vector3d> x;
  std::vector<Eigen::Vector3d> y;
  std::vector<double> weights;
  for (const auto& place : places) {
    if (!evaluation.is_by_all && !is_control(place)) continue;
    x.push_back(place.second);
    y.push_back(place.first.p_enh);
    weights.push_back(weight_of(place.first));
  }
  // Where some deviations are not told, none counts.
  if (std::find(weights.begin(), weights.end(), 0) != weights.end()) {
    std::fill(weights.begin(), weights.end(), 1);
  }
  evaluation.aligned_by = x.size();
  evaluation.enh_map =
      weighted_alignment(x, y, weights, evaluation.alignment == AlignmentMode::kSim3);
}

}  // namespace

std::vector<Stop> find_stops(const Trajectory& T_map_body) {
  constexpr double kStands_m = 0.1;
  constexpr double kLeast_s = 2;
  std::vector<Stop> stops;
  for (std::size_t first = 0; first < T_map_body.size();) {
    std::size_t last = first;
    const Eigen::Vector3d& p = T_map_body.pose(first).translation;
    while (last + 1 < T_map_body.size() &&
           (T_map_body.pose(last + 1).translation - p).norm() <= kStands_m) {
      ++last;
    }
    const geometry::Stamp begin = T_map_body.stamp(first);
    const geometry::Stamp end = T_map_body.stamp(last);
    if (geometry::seconds_between(begin, end) >= kLeast_s) {
      stops.push_back(Stop{begin, end});
      first = last + 1;
    } else {
      ++first;
    }
  }
  return stops;
}

namespace {

/// Of a prism or a receiver many points lie before and after the estimate.
void shorten(std::vector<std::string>& notes) {
  constexpr std::size_t kMostNotes = 10;
  if (notes.size() <= kMostNotes) return;
  const std::size_t more = notes.size() - kMostNotes;
  notes.resize(kMostNotes);
  notes.push_back(fmt::format("and {} more that are not used", more));
}

}  // namespace

CheckpointEvaluation evaluate_checkpoints(const Trajectory& T_map_body,
                                          const std::vector<Checkpoint>& points,
                                          const CheckpointOptions& options) {
  if (!T_map_body.is_stamped()) {
    throw EvaluationError("checkpoints need an estimate whose poses have stamps");
  }
  CheckpointEvaluation evaluation;
  evaluation.alignment = options.alignment;
  const std::vector<Stop> stops = find_stops(T_map_body);
  std::vector<std::pair<Checkpoint, Eigen::Vector3d>> places;
  const auto offset_ns = static_cast<std::int64_t>(std::llround(options.time_offset_s * 1e9));
  for (Checkpoint point : points) {
    if (point.stamp) point.stamp->nanoseconds += offset_ns;
    if (point.until) point.until->nanoseconds += offset_ns;
    std::string why;
    if (const auto place = place_of(point, T_map_body, stops, options, why)) {
      places.emplace_back(point, *place);
    } else {
      evaluation.notes.push_back(fmt::format("{} is not used: {}", point.name, why));
    }
  }
  shorten(evaluation.notes);
  if (places.empty()) {
    throw EvaluationError(
        "none of the checkpoints can be used; " +
        (evaluation.notes.empty() ? std::string("there are none") : evaluation.notes.front()));
  }
  align_to_points(places, evaluation);
  const Similarity& S = evaluation.enh_map;
  for (auto& [point, p_map] : places) {
    CheckpointResidual residual;
    residual.point = point;
    residual.estimate_enh = S.scale * (S.T_y_x.rotation * p_map) + S.T_y_x.translation;
    residual.residual_m = residual.estimate_enh - point.p_enh;
    evaluation.residuals.push_back(std::move(residual));
  }
  evaluation.control = figures_of_kind(evaluation.residuals, true);
  evaluation.check = figures_of_kind(evaluation.residuals, false);
  return evaluation;
}

}  // namespace traverse::evaluation
