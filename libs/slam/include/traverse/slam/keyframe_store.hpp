#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "traverse/slam/keyframe.hpp"

namespace traverse::slam {

class SpillFile;

/// The keyframes of a drive. Their points are large: when those in memory exceed a limit, the
/// oldest go to a temporary file, from which they come back when they are asked for. Copies share
/// keyframes and file, which nobody changes.
class KeyframeStore {
 public:
  /// \param most_bytes of points in memory
  explicit KeyframeStore(std::size_t most_bytes);

  /// \throws std::invalid_argument unless the id is size(); files::OutputError if it must be
  /// spilled and cannot
  void add(Keyframe keyframe);

  std::size_t size() const { return places_.size(); }
  /// \throws std::out_of_range; files::InputError if it was spilled and cannot be read
  std::shared_ptr<const Keyframe> at(std::size_t id) const;

  std::size_t resident_bytes() const { return resident_bytes_; }
  std::size_t spilled() const { return first_resident_; }

 private:
  struct Place {
    std::shared_ptr<const Keyframe> keyframe;  ///< null: in the file
    std::uint64_t offset = 0;
  };

  std::size_t most_bytes_;
  std::size_t resident_bytes_ = 0;
  std::size_t first_resident_ = 0;
  std::vector<Place> places_;
  std::shared_ptr<SpillFile> file_;
};

/// Memory that the points and features of a keyframe take.
std::size_t bytes_of(const Keyframe& keyframe);

}  // namespace traverse::slam
