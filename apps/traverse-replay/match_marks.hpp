#pragma once

#include <memory>
#include <span>

#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CSetOfLines.h>

#include "traverse/pipeline/estimator.hpp"

#include "scene_points.hpp"
#include "view_settings.hpp"

namespace traverse::app {

/// How a scan was registered: each matched point, a piece of each matched line, and of the matched
/// planes evenly chosen normals.
class MatchMarks {
 public:
  explicit MatchMarks(mrpt::opengl::COpenGLScene& scene);

  void show(std::span<const pipeline::MatchedPoint> matches, const ViewSettings& settings);

 private:
  std::shared_ptr<ScenePoints> points_ = std::make_shared<ScenePoints>();
  mrpt::opengl::CSetOfLines::Ptr lines_ = mrpt::opengl::CSetOfLines::Create();
  mrpt::opengl::CSetOfLines::Ptr normals_ = mrpt::opengl::CSetOfLines::Create();
};

}  // namespace traverse::app
