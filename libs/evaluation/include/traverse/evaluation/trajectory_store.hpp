#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "traverse/geometry/pose3.hpp"
#include "traverse/geometry/stamp.hpp"

namespace traverse::files {
class ScratchFile;
}

namespace traverse::evaluation {

/// A trajectory that need not fit into memory. Stamps stay there, 8 bytes a pose; of the poses, 96
/// bytes each, the blocks that were used last, and from kPosesInMemory on the others in a file
/// without a name. So an evaluation, which goes through both trajectories from front to back, takes
/// no more memory for them however long they are.
///
/// Reading moves blocks too: one thread at a time.
class TrajectoryStore {
 public:
  static constexpr std::size_t kBlock = 1024;  ///< poses that go to disk and back together
  static constexpr std::size_t kBlocksInMemory = 64;
  static constexpr std::size_t kPosesInMemory = kBlock * kBlocksInMemory;

  /// \param folder for the file without a name, should it be needed
  explicit TrajectoryStore(std::filesystem::path folder = std::filesystem::temp_directory_path());
  ~TrajectoryStore();
  TrajectoryStore(const TrajectoryStore&) = delete;
  TrajectoryStore& operator=(const TrajectoryStore&) = delete;

  /// With a stamp for each pose or for none. \throws std::logic_error if that changes;
  /// files::OutputError (disk full, the folder does not allow a file)
  void push_back(const std::optional<geometry::Stamp>& stamp, const geometry::Pose3& T_map_body);

  bool is_stamped() const { return size_ == 0 || !stamps_.empty(); }
  std::size_t size() const { return size_; }
  const std::vector<geometry::Stamp>& stamps() const { return stamps_; }
  /// \throws files::OutputError if the file cannot be read
  geometry::Pose3 pose(std::size_t i) const { return (*loaded(i / kBlock).poses)[i % kBlock]; }

 private:
  using Block = std::array<geometry::Pose3, kBlock>;
  /// A block in memory.
  struct Loaded {
    std::unique_ptr<Block> poses;
    std::size_t number = 0;
    std::uint64_t last_used = 0;
    bool changed = false;  ///< since it was last written
  };
  static constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);

  Loaded& loaded(std::size_t number) const {
    const std::size_t slot = slot_of_block_[number];
    if (slot == kNowhere) return load(number);
    slots_[slot].last_used = ++clock_;
    return slots_[slot];
  }
  Loaded& load(std::size_t number) const;
  std::size_t free_slot() const;

  std::filesystem::path folder_;
  std::size_t size_ = 0;
  std::vector<geometry::Stamp> stamps_;
  mutable std::vector<Loaded> slots_;
  mutable std::vector<std::size_t> slot_of_block_;  ///< kNowhere: on disk
  mutable std::vector<std::uint64_t> offset_of_block_;
  mutable std::uint64_t clock_ = 0;
  mutable std::unique_ptr<files::ScratchFile> disk_;
};

}  // namespace traverse::evaluation
