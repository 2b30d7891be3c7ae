#pragma once

#include <filesystem>

namespace traverse::files {

/// Keeps a file or folder in the program's list of what is not finished, as long as it lives. Who
/// writes under a temporary name has one, so that a signal that ends the program leaves nothing.
class Unfinished {
 public:
  /// \param path need not be there yet
  explicit Unfinished(const std::filesystem::path& path);
  ~Unfinished();
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;

 private:
  std::filesystem::path path_;  ///< absolute
};

/// Removes all that is in the list, folders with what is in them. It is the last thing that a
/// program does before it ends: from then on who begins or finishes something waits for ever, so
/// that other threads that still work make nothing new.
void remove_unfinished();

}  // namespace traverse::files
