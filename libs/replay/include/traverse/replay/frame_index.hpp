#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "traverse/dataset/source.hpp"
#include "traverse/geometry/stamp.hpp"

namespace traverse::replay {

/// When the frames of a recording are, found by reading all of it once.
struct FrameIndex {
  std::vector<geometry::Stamp> frames;
  /// Records that could not be used: why, and behind how many frames the first of them stands.
  struct Skipped {
    std::string reason;
    std::size_t count = 0;
    std::size_t first_behind_frames = 0;
  };
  std::vector<Skipped> skipped;

  bool operator==(const FrameIndex&) const = default;
};
inline bool operator==(const FrameIndex::Skipped& a, const FrameIndex::Skipped& b) {
  return a.reason == b.reason && a.count == b.count &&
         a.first_behind_frames == b.first_behind_frames;
}

/// What building an index tells while it works.
struct IndexObserver {
  std::function<void(geometry::Stamp)> frame;  ///< one more is known
  std::function<void(double share)> progress;  ///< 0 to 1
  const std::atomic<bool>* stop = nullptr;
};

/// Reads `source` from its beginning. \returns nothing if it was stopped
std::optional<FrameIndex> build_index(dataset::Source& source, const std::string& frame_sensor,
                                      const IndexObserver& observer);

/// Where the index of a recording is kept: below $XDG_CACHE_HOME or ~/.cache; nothing if neither
/// is known.
std::optional<std::filesystem::path> index_file(const std::filesystem::path& recording);

/// Tells one state of a file from another without reading all of it: SHA-256 of its size and of 64
/// pieces of 64 kB, the first and the last among them.
std::string quick_digest(const std::filesystem::path& file);

/// The index kept in `file`, if it is that of a recording with this digest and frame sensor.
std::optional<FrameIndex> load_index(const std::filesystem::path& file, const std::string& digest,
                                     const std::string& frame_sensor);
/// \throws files::OutputError
void save_index(const std::filesystem::path& file, const std::string& digest,
                const std::string& frame_sensor, const FrameIndex& index);

}  // namespace traverse::replay
