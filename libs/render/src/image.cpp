#include "traverse/render/image.hpp"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "traverse/files/atomic_file.hpp"

namespace traverse::render {

namespace {

std::string encoded(const Image& image, const char* format, const std::vector<int>& parameters) {
  // The matrix only looks at the bytes; OpenCV wants it writable and blue first.
  const cv::Mat view(image.height, image.width, CV_8UC3,
                     const_cast<std::uint8_t*>(image.rgb.data()));
  cv::Mat blue_green_red;
  cv::cvtColor(view, blue_green_red, cv::COLOR_RGB2BGR);
  std::vector<std::uint8_t> bytes;
  cv::imencode(format, blue_green_red, bytes, parameters);
  return {bytes.begin(), bytes.end()};
}

}  // namespace

Colour Image::at(int x, int y) const {
  const std::size_t first = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                 static_cast<std::size_t>(x));
  return {rgb.at(first), rgb.at(first + 1), rgb.at(first + 2)};
}

std::string Image::encode_png() const {
  return encoded(
      *this, ".png",
      {cv::IMWRITE_PNG_COMPRESSION, 6, cv::IMWRITE_PNG_STRATEGY, cv::IMWRITE_PNG_STRATEGY_DEFAULT});
}

std::string Image::encode_webp(int quality) const {
  return encoded(*this, ".webp", {cv::IMWRITE_WEBP_QUALITY, quality});
}

void Image::write_png(const std::filesystem::path& path) const {
  files::write_text(path, encode_png());
}

}  // namespace traverse::render
