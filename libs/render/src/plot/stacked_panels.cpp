#include "plot/stacked_panels.hpp"

#include <algorithm>

namespace traverse::render {

std::vector<StackedPanel> stacked_panels(const Canvas& canvas, const Rect& room,
                                         const std::vector<Axis>& axes) {
  const double footer = x_label_height(canvas);
  const double height = (room.height() - footer) / static_cast<double>(axes.size());
  double left = 0;
  for (const Axis& axis : axes) left = std::max(left, room_for_y_labels(canvas, axis, height));

  std::vector<StackedPanel> panels;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const bool lowest = i + 1 == axes.size();
    const double top = room.top + static_cast<double>(i) * height;
    StackedPanel panel;
    panel.outer = {room.left, top, room.right,
                   top + height + (lowest ? footer : -canvas.sizes().gap)};
    panel.margins.left = left;
    panel.margins.x_labels = lowest;
    panels.push_back(panel);
  }
  return panels;
}

}  // namespace traverse::render
