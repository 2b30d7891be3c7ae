#include "scene.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <mrpt/opengl/CGridPlaneXY.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/CSetOfTriangles.h>
#include <mrpt/opengl/stock_objects.h>

#include "traverse/render/colour_map.hpp"
#include "traverse/render/palette.hpp"
#include "traverse/render/theme.hpp"

#include "look.hpp"
#include "scene_points.hpp"

namespace traverse::app {

using mrpt::img::TColor;
using mrpt::math::TPoint3Df;
using render::Colour;

namespace {

// Together at most 100 000 points: software OpenGL draws these 15 times a second and more.
constexpr std::size_t kMostScanPoints = 32'000;
constexpr std::size_t kMostMapPoints = 60'000;
constexpr std::size_t kLeastMapPoints = 10'000;
constexpr std::size_t kMostLocalPoints = 30'000;
constexpr std::size_t kMapStep = 5'000;
constexpr double kSlowRedraw = 0.055;  // seconds
constexpr double kFastRedraw = 0.035;
constexpr float kMatchHalfLength = 0.4F;  // of the line drawn for a matched line or normal, metres
constexpr float kRibbon = 0.3F;           // width of a path, metres
constexpr Colour kEstimateColour = render::palette::kSkyBlue;
constexpr Colour kBeyondColour = Colour::hex(0x2F5168);  // the same, receding
constexpr double kGridCell = 10;                         // metres
constexpr double kGridHalf = 100;
constexpr double kMapDepth = 12;  // of the heights that the map's colours span, metres

TPoint3Df to_mrpt(const Eigen::Vector3f& p) { return {p.x(), p.y(), p.z()}; }

mrpt::poses::CPose3D to_mrpt(const geometry::Pose3& pose) {
  return mrpt::poses::CPose3D(mrpt::math::CMatrixDouble44(pose.matrix()));
}

/// Every so manieth of `count`, so that about `most` remain.
std::size_t stride_for(std::size_t count, std::size_t most) {
  return std::max<std::size_t>(1, (count + most - 1) / most);
}

/// The map recedes behind the scan: a dark ramp of blue greys by height.
TColor map_colour(double height_share) {
  const Colour low = Colour::hex(0x4A5563);
  const Colour high = Colour::hex(0xB4C6D8);
  return app::to_mrpt(render::mix(low, high, std::clamp(height_share, 0.0, 1.0)));
}

/// A piece of a path as a flat ribbon: the core profile of OpenGL has no wide lines.
void append_ribbon(mrpt::opengl::CSetOfTriangles& ribbon, const Eigen::Vector3f& a,
                   const Eigen::Vector3f& b, float width, Colour colour) {
  const Eigen::Vector3f along = b - a;
  if (along.head<2>().norm() < 1e-4F) return;
  const Eigen::Vector3f side = Eigen::Vector3f(-along.y(), along.x(), 0).normalized() * (width / 2);
  const auto triangle = [&](const Eigen::Vector3f& p, const Eigen::Vector3f& q,
                            const Eigen::Vector3f& r) {
    mrpt::opengl::TTriangle t(to_mrpt(p), to_mrpt(q), to_mrpt(r));
    t.setColor(app::to_mrpt(colour));
    t.computeNormals();
    ribbon.insertTriangle(t);
  };
  triangle(a - side, b - side, b + side);
  triangle(a - side, b + side, a + side);
}

}  // namespace

struct Scene::Objects {
  mrpt::opengl::COpenGLScene::Ptr scene = mrpt::opengl::COpenGLScene::Create();
  std::shared_ptr<ScenePoints> map = std::make_shared<ScenePoints>();
  std::shared_ptr<ScenePoints> scan = std::make_shared<ScenePoints>();
  std::shared_ptr<ScenePoints> local_map = std::make_shared<ScenePoints>();
  std::shared_ptr<ScenePoints> matches = std::make_shared<ScenePoints>();
  mrpt::opengl::CSetOfLines::Ptr match_lines = mrpt::opengl::CSetOfLines::Create();
  mrpt::opengl::CSetOfTriangles::Ptr estimate = mrpt::opengl::CSetOfTriangles::Create();
  mrpt::opengl::CSetOfTriangles::Ptr beyond = mrpt::opengl::CSetOfTriangles::Create();
  mrpt::opengl::CSetOfTriangles::Ptr reference = mrpt::opengl::CSetOfTriangles::Create();
  mrpt::opengl::CSetOfObjects::Ptr vehicle = mrpt::opengl::stock_objects::CornerXYZ(2.0F);
  mrpt::opengl::CGridPlaneXY::Ptr grid = mrpt::opengl::CGridPlaneXY::Create(
      static_cast<float>(-kGridHalf), static_cast<float>(kGridHalf), static_cast<float>(-kGridHalf),
      static_cast<float>(kGridHalf), 0.0F, static_cast<float>(kGridCell), 1.0F);
  std::optional<double> ground_z;
};

Scene::Scene() : objects_(std::make_unique<Objects>()), map_budget_(kMostMapPoints) {
  Objects& o = *objects_;
  const render::Theme dark = render::dark_theme();
  const auto view = o.scene->getViewport("main");
  view->setCustomBackgroundColor({static_cast<float>(dark.background.red) / 255,
                                  static_cast<float>(dark.background.green) / 255,
                                  static_cast<float>(dark.background.blue) / 255, 1});
  view->setViewportClipDistances(0.5F, 5000.0F);
  o.grid->setColor_u8(app::to_mrpt(dark.grid));
  o.map->setPointSize(1.5F);
  o.scan->setPointSize(2.0F);
  o.local_map->setPointSize(2.0F);
  o.matches->setPointSize(4.0F);
  for (const auto& points : {o.map, o.scan, o.local_map, o.matches}) {
    points->enableVariablePointSize(false);
  }
  o.match_lines->setLineWidth(1.5F);
  o.match_lines->setColor_u8(app::to_mrpt(dark.muted));
  for (const auto& ribbon : {o.estimate, o.beyond, o.reference}) ribbon->enableLight(false);
  for (const mrpt::opengl::CRenderizable::Ptr& object :
       {mrpt::opengl::CRenderizable::Ptr(o.grid), mrpt::opengl::CRenderizable::Ptr(o.map),
        mrpt::opengl::CRenderizable::Ptr(o.local_map), mrpt::opengl::CRenderizable::Ptr(o.scan),
        mrpt::opengl::CRenderizable::Ptr(o.matches),
        mrpt::opengl::CRenderizable::Ptr(o.match_lines),
        mrpt::opengl::CRenderizable::Ptr(o.reference), mrpt::opengl::CRenderizable::Ptr(o.estimate),
        mrpt::opengl::CRenderizable::Ptr(o.beyond), mrpt::opengl::CRenderizable::Ptr(o.vehicle)}) {
    o.scene->insert(object);
  }
}

Scene::~Scene() = default;

const mrpt::opengl::COpenGLScene::Ptr& Scene::mrpt_scene() const { return objects_->scene; }

void Scene::set_view(double width, double height, double bottom) {
  objects_->scene->getViewport("main")->setViewportPosition(0, bottom, width, height);
}

void Scene::forget() {
  path_.clear();
  shown_.reset();
  objects_->reference->clearTriangles();
  has_reference_ = false;
  objects_->map->assign({}, {});
  map_is_due_ = true;
}

bool Scene::update(const replay::Player& player, const ViewSettings& settings) {
  const replay::PlayerStatus status = player.status();
  const bool is_other = status.generation != generation_;
  if (is_other) {
    generation_ = status.generation;
    forget();
  }
  const auto shown = player.shown();
  const bool is_new = shown != shown_;
  const bool is_restyled =
      !settings_ || settings_->colour != settings.colour || settings_->layers != settings.layers;
  if (!shown || !(is_new || is_restyled || map_is_due_)) return is_other;
  shown_ = shown;
  settings_ = settings;

  Objects& o = *objects_;
  o.scan->setVisibility(settings.shows(Layer::kScan));
  o.map->setVisibility(settings.shows(Layer::kMap));
  o.local_map->setVisibility(settings.shows(Layer::kLocalMap));
  const bool residuals = settings.colour == replay::ScanColour::kResidual;
  o.matches->setVisibility(settings.shows(Layer::kMatches) || residuals);
  o.match_lines->setVisibility(settings.shows(Layer::kMatches));
  o.estimate->setVisibility(settings.shows(Layer::kEstimate));
  o.beyond->setVisibility(settings.shows(Layer::kEstimate));
  o.reference->setVisibility(settings.shows(Layer::kReference));
  o.grid->setVisibility(settings.shows(Layer::kGrid));

  if (is_new || is_restyled) {
    show_scan(*shown, settings);
    show_matches(*shown, settings);
    if (settings.shows(Layer::kLocalMap)) show_local_map(*shown);
    show_estimate(player, *shown);
    show_reference(player);
    o.vehicle->setPose(to_mrpt(shown->pose.T_map_body));
    const auto snapped = [](double x) { return std::round(x / kGridCell) * kGridCell; };
    const Eigen::Vector3d& p = shown->pose.T_map_body.translation;
    o.grid->setLocation(snapped(p.x()), snapped(p.y()), o.ground_z.value_or(0));
  }
  map_is_due_ = !show_map(player, *shown);
  return true;
}

void Scene::show_scan(const replay::Shown& shown, const ViewSettings& settings) {
  replay::ScanColours coloured = replay::colours_of(shown.scan, settings.colour);
  legend_ = std::move(coloured.legend);
  samples_ = std::move(coloured.samples);
  const auto& all = shown.scan.points_body;
  const std::size_t stride = stride_for(all.size(), kMostScanPoints);
  std::vector<TPoint3Df> points;
  std::vector<TColor> colours;
  for (std::size_t i = 0; i < all.size(); i += stride) {
    points.push_back(to_mrpt(all[i]));
    colours.push_back(app::to_mrpt(coloured.colours[i]));
  }
  if (!objects_->ground_z && !all.empty()) {
    std::vector<float> heights;
    for (const auto& p : all) heights.push_back(p.z());
    const auto rank = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 20);
    std::nth_element(heights.begin(), rank, heights.end());
    objects_->ground_z = *rank;
  }
  scan_drawn_ = points.size();
  objects_->scan->assign(std::move(points), std::move(colours));
  objects_->scan->setPose(to_mrpt(shown.pose.T_map_body));
}

void Scene::show_matches(const replay::Shown& shown, const ViewSettings& settings) {
  const bool residuals = settings.colour == replay::ScanColour::kResidual;
  std::vector<TPoint3Df> points;
  std::vector<TColor> colours;
  objects_->match_lines->clear();
  for (const auto& match : shown.matches) {
    points.push_back(to_mrpt(match.p_map.cast<float>()));
    const Colour by_kind = match.on_line ? render::palette::kOrange : render::palette::kGreen;
    colours.push_back(
        app::to_mrpt(residuals ? replay::residual_colour(match.residual_m) : by_kind));
    if (!settings.shows(Layer::kMatches)) continue;
    const Eigen::Vector3f foot = match.foot_map.cast<float>();
    const Eigen::Vector3f half = kMatchHalfLength * match.direction.cast<float>();
    const Eigen::Vector3f from = match.on_line ? Eigen::Vector3f(foot - half) : foot;
    const Eigen::Vector3f to = foot + half;
    objects_->match_lines->appendLine(from.x(), from.y(), from.z(), to.x(), to.y(), to.z());
  }
  objects_->matches->assign(std::move(points), std::move(colours));
}

void Scene::show_local_map(const replay::Shown& shown) {
  const std::size_t stride = stride_for(shown.local_map.size(), kMostLocalPoints);
  std::vector<TPoint3Df> points;
  for (std::size_t i = 0; i < shown.local_map.size(); i += stride) {
    points.push_back(to_mrpt(shown.local_map[i].cast<float>()));
  }
  std::vector<TColor> colours(points.size(), app::to_mrpt(render::palette::kPurple));
  objects_->local_map->assign(std::move(points), std::move(colours));
}

/// \returns false if the map could not be read just now
bool Scene::show_map(const replay::Player& player, const replay::Shown& shown) {
  const auto chosen =
      player.choose_map(shown.pose.T_map_body.translation.cast<float>(), map_budget_);
  if (!chosen) return false;
  std::vector<TPoint3Df> points;
  std::vector<TColor> colours;
  points.reserve(chosen->points.size());
  colours.reserve(chosen->points.size());
  const double ground = objects_->ground_z.value_or(0);
  for (const Eigen::Vector3f& p : chosen->points) {
    points.push_back(to_mrpt(p));
    colours.push_back(map_colour((static_cast<double>(p.z()) - ground) / kMapDepth + 0.15));
  }
  map_drawn_ = points.size();
  map_points_ = chosen->of;
  objects_->map->assign(std::move(points), std::move(colours));
  return true;
}

/// The path up to the frame on show, and dimmed what was estimated beyond it.
void Scene::show_estimate(const replay::Player& player, const replay::Shown& shown) {
  for (const replay::PastFrame& frame : player.past(path_.size())) {
    path_.push_back(frame.pose.T_map_body.translation.cast<float>());
    if (path_.size() == 1) first_frame_ = frame.number;
  }
  objects_->estimate->clearTriangles();
  objects_->beyond->clearTriangles();
  for (std::size_t i = 0; i + 1 < path_.size(); ++i) {
    if (first_frame_ + i + 1 <= shown.frame) {
      append_ribbon(*objects_->estimate, path_[i], path_[i + 1], kRibbon, kEstimateColour);
    } else {
      append_ribbon(*objects_->beyond, path_[i], path_[i + 1], kRibbon / 2, kBeyondColour);
    }
  }
}

void Scene::show_reference(const replay::Player& player) {
  if (has_reference_) return;
  const std::vector<Eigen::Vector3d> path = player.reference_in_map();
  for (std::size_t i = 0; i + 1 < path.size(); i += 2) {  // every other piece: dashed
    append_ribbon(*objects_->reference, path[i].cast<float>(), path[i + 1].cast<float>(), kRibbon,
                  render::dark_theme().reference);
  }
  has_reference_ = !path.empty();
}

void Scene::adapt(double seconds_a_redraw) {
  if (seconds_a_redraw > kSlowRedraw && map_budget_ > kLeastMapPoints) {
    map_budget_ -= kMapStep;
  } else if (seconds_a_redraw < kFastRedraw && map_budget_ < kMostMapPoints) {
    map_budget_ += kMapStep;
  }
}

}  // namespace traverse::app
