#include "traverse/render/renderer.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "gl/context.hpp"
#include "gl/point_pass.hpp"
#include "gl/shape_pass.hpp"
#include "gl/shape_target.hpp"
#include "gl/tile.hpp"
#include "tessellation.hpp"
#include "typeface.hpp"

namespace traverse::render {

namespace {

constexpr int kLargestSide = 32768;
// With its margins and supersampling, within the 16384 pixels of llvmpipe.
constexpr int kLargestTile = 16384 / gl::kSupersampling - 2 * gl::PointPass::kTileMargin;

/// What is drawn at once, in the order of painting.
struct Step {
  std::optional<Rect> clip;
  std::size_t first_vertex = 0;  // shapes that follow one another with the same clip
  std::size_t vertex_count = 0;
  std::size_t first_cloud = 0;  // or point clouds that follow one another in the same view
  std::size_t cloud_count = 0;
};

/// A drawing as OpenGL takes it.
struct Prepared {
  std::vector<ShapeVertex> vertices;
  std::vector<const PointCloud*> clouds;
  std::vector<Step> steps;
};

bool same_view(const PointCloud& a, const PointCloud& b) {
  return a.camera == b.camera && a.viewport == b.viewport && a.depth_shading == b.depth_shading;
}

void add_cloud(const PointCloud& cloud, const std::optional<Rect>& clip, Prepared& prepared) {
  if (cloud.points.empty()) return;
  const bool first = prepared.steps.empty() || prepared.steps.back().cloud_count == 0 ||
                     prepared.steps.back().clip != clip ||
                     !same_view(*prepared.clouds.back(), cloud);
  if (first) prepared.steps.push_back({clip, 0, 0, prepared.clouds.size(), 0});
  ++prepared.steps.back().cloud_count;
  prepared.clouds.push_back(&cloud);
}

Prepared prepare(const Drawing& drawing) {
  Prepared prepared;
  for (const Drawing::Item& item : drawing.items) {
    if (const auto* cloud = std::get_if<PointCloud>(&item.shape)) {
      add_cloud(*cloud, item.clip, prepared);
      continue;
    }
    const std::size_t first = prepared.vertices.size();
    std::visit(
        [&](const auto& shape) {
          if constexpr (!std::is_same_v<std::decay_t<decltype(shape)>, PointCloud>) {
            tessellate(shape, prepared.vertices);
          }
        },
        item.shape);
    const std::size_t count = prepared.vertices.size() - first;
    Step* last = prepared.steps.empty() ? nullptr : &prepared.steps.back();
    if (last != nullptr && last->cloud_count == 0 && last->clip == item.clip) {
      last->vertex_count += count;
    } else if (count > 0) {
      prepared.steps.push_back({item.clip, first, count, 0, 0});
    }
  }
  return prepared;
}

struct PassesAndTargets {
  PassesAndTargets() : gl(gl::Functions::load()), target(gl), shapes(gl), points(gl) {}
  gl::Functions gl;
  gl::ShapeTarget target;
  gl::ShapePass shapes;
  gl::PointPass points;
};

}  // namespace

class Renderer::Impl {
 public:
  explicit Impl(const Options& options) : options_(options) {
    for (const int side : {options.tile_width, options.tile_height}) {
      if (side < 1 || side > kLargestTile) {
        throw std::invalid_argument(
            fmt::format("a tile is 1 to {} pixels wide and high, not {}", kLargestTile, side));
      }
    }
    context_.run([this] { passes_.emplace(); });
  }

  Image render(const Drawing& drawing) {
    Image image{drawing.width, drawing.height,
                std::vector<std::uint8_t>(3 * static_cast<std::size_t>(drawing.width) *
                                          static_cast<std::size_t>(drawing.height))};
    cv::Mat pixels(image.height, image.width, CV_8UC3, image.rgb.data());
    const Prepared prepared = prepare(drawing);
    context_.run([&] { draw_tiles(prepared, drawing.background, pixels); });
    for (const Text& text : drawing.texts) typeface_.paint(text, pixels);
    return image;
  }

 private:
  void draw_tiles(const Prepared& prepared, Colour background, cv::Mat& pixels) {
    const cv::Rect all(0, 0, pixels.cols, pixels.rows);
    passes_->shapes.upload(prepared.vertices);
    passes_->points.upload(prepared.clouds);
    for (int top = 0; top < all.height; top += options_.tile_height) {
      for (int left = 0; left < all.width; left += options_.tile_width) {
        const cv::Rect tile(left, top, options_.tile_width, options_.tile_height);
        draw_tile(prepared, background, tile & all, pixels);
      }
    }
    passes_->points.release();
  }

  /// Fills `part` of the picture. What is drawn reaches a little over it, since points whose
  /// centre is outside are left out by OpenGL and shading looks at neighbours.
  void draw_tile(const Prepared& prepared, Colour background, const cv::Rect& part,
                 cv::Mat& pixels) {
    constexpr int kMargin = gl::PointPass::kTileMargin;
    const cv::Rect drawn =
        (part + cv::Size(2 * kMargin, 2 * kMargin)) - cv::Point(kMargin, kMargin);
    const gl::Tile tile{drawn.x, drawn.y, drawn.width, drawn.height};
    const Rect everything{static_cast<double>(drawn.x), static_cast<double>(drawn.y),
                          static_cast<double>(drawn.br().x), static_cast<double>(drawn.br().y)};
    const gl::Functions& gl = passes_->gl;
    passes_->target.resize(tile.device_width(), tile.device_height());
    passes_->target.bind();
    gl.Disable(GL_SCISSOR_TEST);
    gl.ClearColor(static_cast<float>(background.red) / 255,
                  static_cast<float>(background.green) / 255,
                  static_cast<float>(background.blue) / 255, 1);
    gl.Clear(GL_COLOR_BUFFER_BIT);
    gl.Enable(GL_SCISSOR_TEST);
    for (const Step& step : prepared.steps) {
      const gl::DeviceRect clip = gl::in_tile(tile, step.clip.value_or(everything));
      if (step.cloud_count == 0) {
        passes_->shapes.draw(tile, clip, step.first_vertex, step.vertex_count);
      } else {
        gl::scissor(gl, clip);
        draw_clouds(prepared, step, tile);
      }
    }
    gl::check(gl, "draw a picture");
    cv::Mat averaged;
    cv::resize(passes_->target.read(), averaged, drawn.size(), 0, 0, cv::INTER_AREA);
    cv::cvtColor(averaged(part - drawn.tl()), pixels(part), cv::COLOR_RGBA2RGB);
  }

  void draw_clouds(const Prepared& prepared, const Step& step, const gl::Tile& tile) {
    passes_->points.begin(tile);
    for (std::size_t i = 0; i < step.cloud_count; ++i) {
      const std::size_t index = step.first_cloud + i;
      passes_->points.draw_points(tile, *prepared.clouds[index], index);
    }
    passes_->target.bind();
    passes_->points.draw_shaded(*prepared.clouds[step.first_cloud]);
  }

  Options options_;
  gl::Context context_;
  Typeface typeface_;
  std::optional<PassesAndTargets> passes_;
};

Renderer::Renderer(const Options& options) : impl_(std::make_unique<Impl>(options)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Image Renderer::render(const Drawing& drawing) {
  for (const int side : {drawing.width, drawing.height}) {
    if (side < 1 || side > kLargestSide) {
      throw std::invalid_argument(
          fmt::format("a picture is 1 to {} pixels wide and high, not {} x {}", kLargestSide,
                      drawing.width, drawing.height));
    }
  }
  return impl_->render(drawing);
}

}  // namespace traverse::render
