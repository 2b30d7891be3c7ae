#pragma once

#include <filesystem>

namespace traverse::batch {

/// Keeps a second batch out of a folder. The system holds the lock for the process and lets go of
/// it when the process ends in whatever way, so there are no stale ones; the file says who has it.
class BatchLock {
 public:
  /// \throws std::runtime_error naming who holds it; files::OutputError if it cannot be made.
  explicit BatchLock(const std::filesystem::path& file);
  ~BatchLock();
  BatchLock(const BatchLock&) = delete;
  BatchLock& operator=(const BatchLock&) = delete;

  /// Whether some process holds the lock now.
  static bool is_held(const std::filesystem::path& file);

 private:
  int descriptor_;
};

}  // namespace traverse::batch
