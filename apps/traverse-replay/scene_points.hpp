#pragma once

#include <vector>

#include <mrpt/opengl/CRenderizableShaderPoints.h>

namespace traverse::app {

/// Points with a colour each, given to the graphics card as they are. MRPT's own coloured cloud
/// builds an octree of them first, with every change.
class ScenePoints : public mrpt::opengl::CRenderizableShaderPoints {
  DEFINE_SERIALIZABLE(ScenePoints, traverse::app)

 public:
  void assign(std::vector<mrpt::math::TPoint3Df> points, std::vector<mrpt::img::TColor> colours);

  void onUpdateBuffers_Points() override {}
  mrpt::math::TBoundingBoxf internalBoundingBoxLocal() const override {
    return verticesBoundingBox();
  }
};

}  // namespace traverse::app
