#pragma once

#include <filesystem>
#include <memory>

#include "traverse/files/unfinished.hpp"

namespace traverse::files {

/// A new file or folder beside the place that it is for: ".map.ply.traverse-4711-0.partial", with
/// the number of the process and one more. Its maker holds a lock (flock) on it, which the system
/// lets go of however the maker ends: so a later program can tell what a dead one left from what
/// another is writing just now, on other machines and in other containers too.
///
/// Making one first removes what dead programs left in the same folder.
class Temporary {
 public:
  enum class Kind { kFile, kFolder };
  /// \throws OutputError naming `place` and the system's reason.
  Temporary(Kind kind, const std::filesystem::path& place);
  /// Removes it, with all that is in it, unless it has been kept.
  ~Temporary();
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// It has got its name: nothing is there to be removed.
  void keep();

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::unique_ptr<Unfinished> unfinished_;
};

}  // namespace traverse::files
