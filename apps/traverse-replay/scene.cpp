#include "scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include <mrpt/opengl/CGridPlaneXY.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/CSetOfTriangles.h>
#include <mrpt/opengl/stock_objects.h>

#include "traverse/render/theme.hpp"
#include "traverse/statistics/quantile.hpp"

#include "layer_colours.hpp"
#include "look.hpp"
#include "match_marks.hpp"
#include "path_ribbon.hpp"
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
constexpr std::size_t kSparseScan = 3'000;  // points: fewer are drawn larger
constexpr float kRibbon = 0.3F;             // width of a path, metres
constexpr float kGridCell = 10;             // metres
constexpr float kGridHalf = 100;
constexpr double kMapDepth = 12;  // of the heights that the map's colours span, metres
constexpr std::size_t kMapShades = 64;
constexpr double kRobot = 0.2;  // size of what a 2-D laser is on, against a car

/// Every so manieth of `count`, so that about `most` remain.
std::size_t stride_for(std::size_t count, std::size_t most) {
  return std::max<std::size_t>(1, (count + most - 1) / most);
}

std::array<TColor, kMapShades> map_shades() {
  std::array<TColor, kMapShades> shades;
  for (std::size_t k = 0; k < kMapShades; ++k) {
    const double share = static_cast<double>(k) / (kMapShades - 1);
    shades[k] = to_mrpt(render::mix(kLowMapColour, kHighMapColour, share));
  }
  return shades;
}

}  // namespace

struct Scene::Objects {
  mrpt::opengl::COpenGLScene::Ptr scene = mrpt::opengl::COpenGLScene::Create();
  std::shared_ptr<ScenePoints> map = std::make_shared<ScenePoints>();
  std::shared_ptr<ScenePoints> scan = std::make_shared<ScenePoints>();
  std::shared_ptr<ScenePoints> local_map = std::make_shared<ScenePoints>();
  MatchMarks matches{*scene};
  mrpt::opengl::CSetOfTriangles::Ptr estimate = mrpt::opengl::CSetOfTriangles::Create();
  mrpt::opengl::CSetOfTriangles::Ptr beyond = mrpt::opengl::CSetOfTriangles::Create();
  mrpt::opengl::CSetOfTriangles::Ptr reference = mrpt::opengl::CSetOfTriangles::Create();
  mrpt::opengl::CSetOfObjects::Ptr vehicle;
  mrpt::opengl::CGridPlaneXY::Ptr grid;
  std::optional<double> ground_z;

  explicit Objects(float scale)
      : vehicle(mrpt::opengl::stock_objects::CornerXYZ(2 * scale)),
        grid(mrpt::opengl::CGridPlaneXY::Create(-kGridHalf * scale, kGridHalf * scale,
                                                -kGridHalf * scale, kGridHalf * scale, 0.0F,
                                                kGridCell * scale, 1.0F)) {}
};

double Scene::scale_of(const replay::Recording& recording) {
  const bool robot = !recording.has_lidar() &&
                     recording.info().rig.first(sensors::SensorKind::kPlanarLaser) != nullptr;
  return robot ? kRobot : 1;
}

Scene::Scene(double scale)
    : objects_(std::make_unique<Objects>(static_cast<float>(scale))),
      scale_(scale),
      map_budget_(kMostMapPoints) {
  Objects& o = *objects_;
  const render::Theme dark = render::dark_theme();
  const auto view = o.scene->getViewport("main");
  view->setCustomBackgroundColor({static_cast<float>(dark.background.red) / 255,
                                  static_cast<float>(dark.background.green) / 255,
                                  static_cast<float>(dark.background.blue) / 255, 1});
  view->setViewportClipDistances(0.2F, 5000.0F);
  o.grid->setColor_u8(to_mrpt(dark.grid));
  o.map->setPointSize(1.5F);
  o.scan->setPointSize(2.0F);
  o.local_map->setPointSize(2.0F);
  for (const auto& points : {o.map, o.scan, o.local_map}) {
    points->enableVariablePointSize(false);
  }
  for (const auto& ribbon : {o.estimate, o.beyond, o.reference}) ribbon->enableLight(false);
  for (const mrpt::opengl::CRenderizable::Ptr& object :
       {mrpt::opengl::CRenderizable::Ptr(o.grid), mrpt::opengl::CRenderizable::Ptr(o.map),
        mrpt::opengl::CRenderizable::Ptr(o.local_map), mrpt::opengl::CRenderizable::Ptr(o.scan),
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
  o.estimate->setVisibility(settings.shows(Layer::kEstimate));
  o.beyond->setVisibility(settings.shows(Layer::kEstimate));
  o.reference->setVisibility(settings.shows(Layer::kReference));
  o.grid->setVisibility(settings.shows(Layer::kGrid));

  if (is_new || is_restyled) {
    show_scan(*shown, settings);
    o.matches.show(shown->matches, settings);
    if (settings.shows(Layer::kLocalMap)) show_local_map(*shown);
    show_estimate(player, *shown);
    show_reference(player);
    o.vehicle->setPose(to_mrpt(shown->pose.T_map_body));
    const double cell = kGridCell * scale_;
    const auto snapped = [&](double x) { return std::round(x / cell) * cell; };
    const Eigen::Vector3d& p = shown->pose.T_map_body.translation;
    o.grid->setLocation(snapped(p.x()), snapped(p.y()), o.ground_z.value_or(0));
  }
  map_is_due_ = !show_map(player, *shown);
  return true;
}

void Scene::show_scan(const replay::Shown& shown, const ViewSettings& settings) {
  replay::ScanColours coloured = replay::colours_of(shown.scan, settings.colour);
  legend_ = std::move(coloured.legend);
  const auto& all = shown.scan.points_body;
  const std::size_t stride = stride_for(all.size(), kMostScanPoints);
  std::vector<TPoint3Df> points;
  std::vector<TColor> colours;
  for (std::size_t i = 0; i < all.size(); i += stride) {
    points.push_back(to_mrpt(all[i]));
    colours.push_back(to_mrpt(coloured.colours[i]));
  }
  if (!objects_->ground_z && !all.empty()) {
    std::vector<float> heights;
    for (const auto& p : all) heights.push_back(p.z());
    objects_->ground_z = statistics::element_at_share(heights, 0.05);
  }
  scan_drawn_ = points.size();
  objects_->scan->setPointSize(all.size() < kSparseScan ? 3.5F : 2.0F);
  objects_->scan->assign(std::move(points), std::move(colours));
  objects_->scan->setPose(to_mrpt(shown.pose.T_map_body));
}

void Scene::show_local_map(const replay::Shown& shown) {
  const std::size_t stride = stride_for(shown.local_map.size(), kMostLocalPoints);
  std::vector<TPoint3Df> points;
  for (std::size_t i = 0; i < shown.local_map.size(); i += stride) {
    points.push_back(to_mrpt(shown.local_map[i].cast<float>()));
  }
  std::vector<TColor> colours(points.size(), to_mrpt(kLocalMapColour));
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
  static const std::array<TColor, kMapShades> kShades = map_shades();
  const double ground = objects_->ground_z.value_or(0);
  for (const Eigen::Vector3f& p : chosen->points) {
    points.push_back(to_mrpt(p));
    const double share = (static_cast<double>(p.z()) - ground) / kMapDepth + 0.15;
    const double shade = std::clamp(share, 0.0, 1.0) * (kMapShades - 1);
    colours.push_back(kShades[static_cast<std::size_t>(shade)]);
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
  const float width = kRibbon * static_cast<float>(scale_);
  const std::span<const Eigen::Vector3f> path(path_);
  const bool is_on_path = shown.frame >= first_frame_ && shown.frame - first_frame_ < path.size();
  const std::size_t here = is_on_path ? shown.frame - first_frame_ : 0;
  draw_path(path.first(std::min(here + 1, path.size())), here, {width, kEstimateColour},
            *objects_->estimate);
  draw_path(path.subspan(std::min(here, path.size())), 0, {width / 2, kBeyondColour},
            *objects_->beyond);
}

void Scene::show_reference(const replay::Player& player) {
  if (has_reference_) return;
  std::vector<Eigen::Vector3f> path;
  for (const Eigen::Vector3d& p : player.reference_in_map()) path.push_back(p.cast<float>());
  const float width = kRibbon * static_cast<float>(scale_);
  draw_path(path, 0, {width, render::dark_theme().reference, true}, *objects_->reference);
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
