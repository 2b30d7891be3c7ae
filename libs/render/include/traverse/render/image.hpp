#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "traverse/render/colour.hpp"

namespace traverse::render {

/// A finished picture: three bytes a pixel (red, green, blue), row after row from the top left.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;

  Colour at(int x, int y) const;

  /// The bytes of a PNG file. Equal images give equal bytes.
  std::string encode_png() const;

  /// The bytes of a WebP file with losses that the eye does not see at `quality` 80 of 100: a map
  /// of points in a third of the bytes of a PNG.
  std::string encode_webp(int quality = 80) const;

  /// Writes a PNG file, atomically. \throws files::OutputError if the folder is missing, the disk
  /// is full, ...
  void write_png(const std::filesystem::path& path) const;

  bool operator==(const Image&) const = default;
};

}  // namespace traverse::render
