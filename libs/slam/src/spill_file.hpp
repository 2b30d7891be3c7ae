#pragma once

#include <cstdint>
#include <filesystem>

#include "traverse/files/scratch_file.hpp"
#include "traverse/parallel/mutex.hpp"
#include "traverse/slam/keyframe.hpp"

namespace traverse::slam {

/// Keyframes on disk as long as somebody uses them.
class SpillFile {
 public:
  /// \throws files::OutputError if `folder` does not allow a file
  explicit SpillFile(const std::filesystem::path& folder);

  /// \returns where it begins \throws files::OutputError if the disk is full
  std::uint64_t append(const Keyframe& keyframe);
  /// \throws files::OutputError if it cannot be read again
  Keyframe read(std::uint64_t offset);

 private:
  parallel::Mutex mutex_;  // copies of a store may live in different threads
  files::ScratchFile file_ TRAVERSE_GUARDED_BY(mutex_);
};

}  // namespace traverse::slam
