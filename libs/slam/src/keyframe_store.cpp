#include "traverse/slam/keyframe_store.hpp"

#include <stdexcept>
#include <utility>

#include "spill_file.hpp"

namespace traverse::slam {

namespace {

std::size_t bytes_of(const voxel_map::SweepPoints& points) {
  return points.size() * (5 * sizeof(float) + sizeof(std::uint32_t));
}

}  // namespace

std::size_t bytes_of(const Keyframe& keyframe) {
  const KeyframePoints& points = keyframe.points;
  const voxel_map::SweepSample& features = keyframe.features;
  return sizeof(Keyframe) +
         sizeof(float) * (3 * points.size() + points.intensity.size() + points.time.size()) +
         sizeof(std::uint16_t) * points.ring.size() + bytes_of(features.surface) +
         bytes_of(features.planar) + bytes_of(features.edges) + features.surface_is_planar.size();
}

KeyframeStore::KeyframeStore(std::size_t max_bytes)
    : max_bytes_(max_bytes), folder_(std::filesystem::temp_directory_path()) {}

void KeyframeStore::add(Keyframe keyframe) {
  if (keyframe.id != size()) throw std::invalid_argument("keyframes are stored in their order");
  resident_bytes_ += bytes_of(keyframe);
  places_.push_back({std::make_shared<const Keyframe>(std::move(keyframe)), 0});
  while (resident_bytes_ > max_bytes_ && first_resident_ + 1 < size()) {
    if (file_ == nullptr) file_ = std::make_shared<SpillFile>(folder_);
    Place& oldest = places_[first_resident_++];
    oldest.offset = file_->append(*oldest.keyframe);
    resident_bytes_ -= bytes_of(*oldest.keyframe);
    oldest.keyframe.reset();
  }
}

std::shared_ptr<const Keyframe> KeyframeStore::at(std::size_t id) const {
  const Place& place = places_.at(id);
  if (place.keyframe != nullptr) return place.keyframe;
  return std::make_shared<const Keyframe>(file_->read(place.offset));
}

}  // namespace traverse::slam
