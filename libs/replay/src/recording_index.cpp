#include "recording_index.hpp"

namespace traverse::replay {

std::optional<FrameIndex> index_of(const Recording& recording, bool keep,
                                   const IndexObserver& observer) {
  const auto source = recording.source();
  if (auto listed = source->listed_scan_stamps()) return FrameIndex{std::move(*listed), {}};

  const auto& path = recording.info().path;
  const auto file = keep ? index_file(path) : std::nullopt;
  const std::string digest = file ? quick_digest(path) : "";
  if (file) {
    if (auto kept = load_index(*file, digest, recording.frame_sensor())) return kept;
  }
  auto built = build_index(*source, recording.frame_sensor(), observer);
  if (built && file) save_index(*file, digest, recording.frame_sensor(), *built);
  return built;
}

}  // namespace traverse::replay
