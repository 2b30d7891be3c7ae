#include "match_marks.hpp"

#include <utility>
#include <vector>

#include "layer_colours.hpp"
#include "look.hpp"

namespace traverse::app {

namespace {

constexpr std::size_t kMostNormals = 2'000;
constexpr float kHalfLength = 0.4F;  // of the line drawn for a matched line or normal, metres
constexpr float kPointSize = 4;
constexpr double kFaded = 0.4;  // of the normals, towards the background

void append(mrpt::opengl::CSetOfLines& lines, const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  lines.appendLine(a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
}

}  // namespace

MatchMarks::MatchMarks(mrpt::opengl::COpenGLScene& scene) {
  points_->setPointSize(kPointSize);
  points_->enableVariablePointSize(false);
  lines_->setColor_u8(to_mrpt(kLineMatchColour));
  normals_->setColor_u8(
      to_mrpt(render::mix(kPlaneMatchColour, render::dark_theme().background, kFaded)));
  scene.insert(points_);
  scene.insert(lines_);
  scene.insert(normals_);
}

void MatchMarks::show(std::span<const pipeline::MatchedPoint> matches,
                      const ViewSettings& settings) {
  const bool residuals = settings.colour == replay::ScanColour::kResidual;
  const bool marks = settings.shows(Layer::kMatches);
  points_->setVisibility(marks || residuals);
  lines_->setVisibility(marks);
  normals_->setVisibility(marks);
  lines_->clear();
  normals_->clear();
  std::vector<mrpt::math::TPoint3Df> points;
  std::vector<mrpt::img::TColor> colours;
  const std::size_t stride = 1 + matches.size() / kMostNormals;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const pipeline::MatchedPoint& match = matches[i];
    points.push_back(to_mrpt(match.p_map.cast<float>()));
    const render::Colour by_kind = match.on_line ? kLineMatchColour : kPlaneMatchColour;
    colours.push_back(to_mrpt(residuals ? replay::residual_colour(match.residual_m) : by_kind));
    const Eigen::Vector3f foot = match.foot_map.cast<float>();
    const Eigen::Vector3f half = kHalfLength * match.direction.cast<float>();
    if (match.on_line) {
      append(*lines_, foot - half, foot + half);
    } else if (i % stride == 0) {
      append(*normals_, foot, foot + half);
    }
  }
  points_->assign(std::move(points), std::move(colours));
}

}  // namespace traverse::app
