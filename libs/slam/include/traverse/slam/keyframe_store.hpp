#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "traverse/slam/keyframe.hpp"

namespace traverse::slam {

class SpillFile;

/// The keyframes of a drive. Their points are large: when those in memory exceed a limit, the
/// oldest go to a file without a name, from which they come back when they are asked for. Copies
/// share keyframes and file, which nobody changes.
class KeyframeStore {
 public:
  /// \param max_bytes of points in memory
  explicit KeyframeStore(std::size_t max_bytes);

  /// Where the file is made, when it is needed; without it, in the system's folder for temporary
  /// files.
  void spill_to(std::filesystem::path folder) { folder_ = std::move(folder); }

  /// \throws std::invalid_argument unless the id is size(); files::OutputError if it must be
  /// spilled and cannot
  void add(Keyframe keyframe);

  std::size_t size() const { return places_.size(); }
  /// \throws std::out_of_range; files::OutputError if it was spilled and cannot be read
  std::shared_ptr<const Keyframe> at(std::size_t id) const;

  std::size_t resident_bytes() const { return resident_bytes_; }
  std::size_t spilled() const { return first_resident_; }

 private:
  struct Place {
    std::shared_ptr<const Keyframe> keyframe;  ///< null: in the file
    std::uint64_t offset = 0;
  };

  std::size_t max_bytes_;
  std::filesystem::path folder_;
  std::size_t resident_bytes_ = 0;
  std::size_t first_resident_ = 0;
  std::vector<Place> places_;
  std::shared_ptr<SpillFile> file_;
};

/// Memory that the points and features of a keyframe take.
std::size_t bytes_of(const Keyframe& keyframe);

}  // namespace traverse::slam
