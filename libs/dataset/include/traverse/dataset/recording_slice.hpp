#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <string>

#include "traverse/dataset/source.hpp"

namespace traverse::dataset {

/// A stretch of a recording, by the scans of one lidar.
struct Slice {
  std::string lidar;      ///< label; empty: of the first lidar or, without any, 2-D laser
  std::size_t first = 0;  ///< frames are counted from 0, both ends are included
  std::size_t last = std::numeric_limits<std::size_t>::max();
};

struct SliceCount {
  std::size_t frames = 0;
  std::size_t others = 0;
};

/// Calls `use` with every measurement from behind frame `first` - 1 to before frame `last` + 1, so
/// that what the other sensors saw during the slice's sweeps is in it. Reads no further.
SliceCount for_each_in_slice(Source& source, const Slice& slice,
                             const std::function<void(const sensors::Measurement&)>& use);

}  // namespace traverse::dataset
