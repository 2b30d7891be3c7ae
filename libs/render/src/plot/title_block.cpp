#include "plot/title_block.hpp"

#include <vector>

namespace traverse::render {

namespace {

constexpr double kLargestShare = 0.32;  // of the page's height: then lines are left out

std::string provenance(const Caption& caption) {
  std::string text;
  for (const std::string& part : {caption.recording, caption.preset, caption.date}) {
    if (part.empty()) continue;
    text += (text.empty() ? "" : "  ·  ") + part;
  }
  return text;
}

}  // namespace

Rect draw_title_block(Canvas& canvas, const Caption& caption, const std::string& usual_title) {
  const Sizes& sizes = canvas.sizes();
  const Theme& theme = canvas.theme();
  const Rect page = canvas.page();
  const Rect room = page.inset(sizes.margin);
  const double lowest = kLargestShare * page.height();

  const std::string title = canvas.fitted(caption.title.empty() ? usual_title : caption.title,
                                          sizes.title, room.width(), FontWeight::kBold);
  const double baseline = room.top + 0.75 * sizes.title;
  canvas.text({title,
               {room.left, baseline},
               sizes.title,
               FontWeight::kBold,
               HorizontalAlign::kLeft,
               theme.text,
               {}});

  // The provenance stands at the right of the title where there is room, else in a line below.
  const std::string origin = provenance(caption);
  const double title_width = canvas.width_of(title, sizes.title, FontWeight::kBold);
  const bool beside =
      canvas.width_of(origin, sizes.body) <= room.width() - title_width - 4 * sizes.gap;
  if (beside) {
    canvas.text(coloured(canvas.body(origin, {room.right, baseline}, HorizontalAlign::kRight),
                         theme.muted));
  }
  double bottom = baseline + 0.3 * sizes.title;
  const auto add_line = [&](const std::string& line, Colour colour) {
    const double next = bottom + 0.2 * sizes.gap + sizes.body;
    if (line.empty() || next > lowest) return;
    const std::string fitted = canvas.fitted(line, sizes.body, room.width());
    if (canvas.text(coloured(canvas.body(fitted, {room.left, next}), colour))) {
      bottom = next + 0.3 * sizes.body;
    }
  };
  add_line(caption.statistic, theme.text);
  if (!beside) add_line(origin, theme.muted);
  return {room.left, bottom + 1.5 * sizes.gap, room.right, room.bottom};
}

}  // namespace traverse::render
