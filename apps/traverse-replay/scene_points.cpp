#include "scene_points.hpp"

#include <mutex>
#include <utility>

#include <mrpt/serialization/CArchive.h>

IMPLEMENTS_SERIALIZABLE(ScenePoints, CRenderizable, traverse::app)

namespace traverse::app {

void ScenePoints::assign(std::vector<mrpt::math::TPoint3Df> points,
                         std::vector<mrpt::img::TColor> colours) {
  {
    const std::unique_lock lock(m_pointsMtx.data);
    m_vertex_buffer_data = std::move(points);
    m_color_buffer_data = std::move(colours);
  }
  CRenderizable::notifyChange();
}

// A scene is never saved, but MRPT asks of all that is in one that it could be.
uint8_t ScenePoints::serializeGetVersion() const { return 0; }
void ScenePoints::serializeTo(mrpt::serialization::CArchive& out) const {
  writeToStreamRender(out);
}
void ScenePoints::serializeFrom(mrpt::serialization::CArchive& in, uint8_t /*version*/) {
  readFromStreamRender(in);
}

}  // namespace traverse::app
