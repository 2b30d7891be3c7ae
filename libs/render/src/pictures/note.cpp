#include "pictures/note.hpp"

namespace traverse::render {

void draw_note(Canvas& canvas, const Rect& room, const std::string& text) {
  const double size = canvas.sizes().body;
  const Text note =
      canvas.body(canvas.fitted(text, size, room.width()),
                  {room.centre().x, room.top + 0.2 * room.height()}, HorizontalAlign::kCentre);
  canvas.text(canvas.on_data(coloured(note, canvas.theme().muted)));
}

}  // namespace traverse::render
