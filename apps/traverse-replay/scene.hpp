#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <mrpt/opengl/COpenGLScene.h>

#include "traverse/replay/player.hpp"

#include "view_settings.hpp"

namespace traverse::app {

/// What the view shows, as MRPT's scene, brought up to date from the player.
class Scene {
 public:
  /// \param scale of lengths that are drawn: 1 for a car
  explicit Scene(double scale);
  ~Scene();

  /// Robots with a 2-D laser are drawn smaller and looked at from nearer than cars.
  static double scale_of(const replay::Recording& recording);

  const mrpt::opengl::COpenGLScene::Ptr& mrpt_scene() const;

  /// The part of the window that the view covers, shares from the lower left.
  void set_view(double width, double height, double bottom);

  /// \returns whether anything changed
  bool update(const replay::Player& player, const ViewSettings& settings);

  /// What the colours of the scan mean.
  const replay::ColourLegend& legend() const { return legend_; }
  std::size_t points_drawn() const { return map_drawn_ + scan_drawn_; }
  std::size_t map_points() const { return map_points_; }

  /// Drawing was slower or faster than it should be: fewer or more points of the map.
  void adapt(double seconds_a_redraw);

 private:
  struct Objects;

  void forget();
  void show_scan(const replay::Shown& shown, const ViewSettings& settings);
  void show_local_map(const replay::Shown& shown);
  bool show_map(const replay::Player& player, const replay::Shown& shown);
  void show_estimate(const replay::Player& player, const replay::Shown& shown);
  void show_reference(const replay::Player& player);

  std::unique_ptr<Objects> objects_;
  double scale_;
  replay::ColourLegend legend_;
  std::shared_ptr<const replay::Shown> shown_;
  std::optional<ViewSettings> settings_;
  unsigned generation_ = 0;
  std::vector<Eigen::Vector3f> path_;  // of the estimate, map frame
  std::size_t first_frame_ = 0;        // of path_
  std::size_t map_budget_;
  std::size_t map_drawn_ = 0;
  std::size_t map_points_ = 0;
  std::size_t scan_drawn_ = 0;
  bool map_is_due_ = false;
  bool has_reference_ = false;
};

}  // namespace traverse::app
