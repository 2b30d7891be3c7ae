#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <mutex>

#include "traverse/slam/keyframe.hpp"

namespace traverse::slam {

/// A temporary file of keyframes that is gone with its last user.
class SpillFile {
 public:
  /// \throws files::OutputError if there is no room for temporary files
  SpillFile();
  ~SpillFile();
  SpillFile(const SpillFile&) = delete;
  SpillFile& operator=(const SpillFile&) = delete;

  /// \returns where it begins \throws files::OutputError if the disk is full
  std::uint64_t append(const Keyframe& keyframe);
  /// \throws files::InputError if the file was damaged
  Keyframe read(std::uint64_t offset);

 private:
  std::mutex mutex_;  // copies of a store may live in different threads
  std::filesystem::path path_;
  std::fstream stream_;
};

}  // namespace traverse::slam
