#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "traverse/render/camera.hpp"
#include "traverse/render/colour.hpp"
#include "traverse/render/rect.hpp"

/// What a picture consists of, before any pixel is set. Pictures are functions from data to a
/// Drawing, a Renderer turns it into an Image: so a test can ask a picture where its labels stand,
/// and another medium (vector graphics) needs only another renderer. Coordinates are pixels of the
/// finished image, x to the right, y down, the origin at the outer corner of the top left pixel.
namespace traverse::render {

enum class LineCap { kRound, kButt };

/// A line through points, joined round. Points that are not finite interrupt it.
struct Polyline {
  std::vector<Point> points;
  Colour colour;
  double width = 2;
  std::vector<double> dashes;   ///< lengths drawn and left out in turn, pixels; empty: solid
  std::vector<Colour> colours;  ///< one a point, instead of `colour`; or empty
  LineCap cap = LineCap::kRound;
  bool closed = false;
};

/// A filled convex polygon.
struct Polygon {
  std::vector<Point> corners;
  Colour fill;
  double opacity = 1;
};

/// A filled circle.
struct Disc {
  Point centre;
  double radius = 1;
  Colour fill;
  double opacity = 1;
};

/// A point of a cloud, metres in the scene's frame. Scenes have their origin near their points: the
/// picture subtracts it in double, for a float holds map coordinates only to decimetres.
struct ScenePoint {
  float x = 0;
  float y = 0;
  float z = 0;
  Colour colour;
};

enum class Splat { kRound, kSquare };

/// Points in space seen by a camera; the nearer covers the farther. A cloud after another covers it
/// whatever its depth, as every shape does.
struct PointCloud {
  std::vector<ScenePoint> points;
  Camera camera;
  Rect viewport;  ///< the pixels that the camera's view fills
  Splat splat = Splat::kRound;
  double diameter = 2;  ///< pixels
  /// Eye-dome lighting: how much points behind a nearer neighbour are darkened; 0 for not at all.
  double depth_shading = 0;
};

enum class FontWeight { kRegular, kBold };
enum class HorizontalAlign { kLeft, kCentre, kRight };

/// A single line of UTF-8, drawn above all shapes.
struct Text {
  std::string utf8;
  Point anchor;      ///< on the baseline, at the side that `align` says
  double size = 16;  ///< pixels of the em square
  FontWeight weight = FontWeight::kRegular;
  HorizontalAlign align = HorizontalAlign::kLeft;
  Colour colour;
  std::optional<Colour> halo;  ///< a soft edge that lifts the text off busy ground
};

using Shape = std::variant<Polyline, Polygon, Disc, PointCloud>;

struct Drawing {
  struct Item {
    Shape shape;
    std::optional<Rect> clip;  ///< nothing is drawn outside
  };

  int width = 0;   ///< pixels
  int height = 0;  ///< pixels
  Colour background;
  std::vector<Item> items;  ///< in the order of painting
  std::vector<Text> texts;
};

}  // namespace traverse::render
