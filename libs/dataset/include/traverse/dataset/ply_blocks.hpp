#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>

#include "traverse/dataset/point_cloud_file.hpp"

namespace traverse::dataset {

/// The points of a binary PLY file block by block, so that a file larger than memory can be read.
class PlyBlocks {
 public:
  /// Reads the header. \throws files::InputError if it is wrong, if the file is ascii, if lists or
  /// other elements stand before or among the points, or if the file is too short for its points
  explicit PlyBlocks(const std::filesystem::path& file);
  PlyBlocks(PlyBlocks&&) noexcept;
  PlyBlocks& operator=(PlyBlocks&&) noexcept;
  ~PlyBlocks();

  std::size_t size() const;  ///< points of the file

  /// The next points, in the order of the file; nothing behind the last one.
  /// \throws files::InputError if they cannot be read
  std::optional<PointCloud> next();

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace traverse::dataset
