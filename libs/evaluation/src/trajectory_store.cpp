#include "traverse/evaluation/trajectory_store.hpp"

#include <algorithm>
#include <span>
#include <stdexcept>
#include <utility>

#include "traverse/files/scratch_file.hpp"

namespace traverse::evaluation {

using geometry::Pose3;

namespace {

static_assert(sizeof(Pose3) == 12 * sizeof(double));  // nothing but its numbers goes to disk

}  // namespace

TrajectoryStore::TrajectoryStore(std::filesystem::path folder) : folder_(std::move(folder)) {}
TrajectoryStore::~TrajectoryStore() = default;

void TrajectoryStore::push_back(const std::optional<geometry::Stamp>& stamp,
                                const Pose3& T_map_body) {
  if (size_ > 0 && stamp.has_value() != is_stamped()) {
    throw std::logic_error("a trajectory has a stamp for each pose or for none");
  }
  const std::size_t number = size_ / kBlock;
  if (number == slot_of_block_.size()) {
    const std::size_t slot = free_slot();
    slots_[slot].number = number;
    slot_of_block_.push_back(slot);
    offset_of_block_.push_back(0);
  }
  Loaded& block = loaded(number);
  (*block.poses)[size_ % kBlock] = T_map_body;
  block.changed = true;
  if (stamp) stamps_.push_back(*stamp);
  ++size_;
}

TrajectoryStore::Loaded& TrajectoryStore::load(std::size_t number) const {
  const std::size_t slot = free_slot();
  Loaded& block = slots_[slot];
  disk_->read(offset_of_block_[number], std::as_writable_bytes(std::span(*block.poses)));
  block.number = number;
  block.changed = false;
  block.last_used = ++clock_;
  slot_of_block_[number] = slot;
  return block;
}

/// A new one, or that of the block that was not used for longest, which goes to disk.
std::size_t TrajectoryStore::free_slot() const {
  if (slots_.size() < kBlocksInMemory) {
    slots_.push_back({std::make_unique<Block>()});
    return slots_.size() - 1;
  }
  const auto oldest =
      std::min_element(slots_.begin(), slots_.end(),
                       [](const Loaded& a, const Loaded& b) { return a.last_used < b.last_used; });
  if (oldest->changed) {
    if (!disk_) disk_ = std::make_unique<files::ScratchFile>(folder_);
    offset_of_block_[oldest->number] = disk_->append(std::as_bytes(std::span(*oldest->poses)));
    oldest->changed = false;
  }
  slot_of_block_[oldest->number] = kNowhere;
  return static_cast<std::size_t>(oldest - slots_.begin());
}

}  // namespace traverse::evaluation
