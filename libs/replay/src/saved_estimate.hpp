#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "traverse/dataset/source.hpp"
#include "traverse/geometry/trajectory.hpp"
#include "traverse/replay/map_history.hpp"

namespace traverse::replay {

/// Writes an estimate as `folder`, which must be new or empty: trajectory.tum, map.ply with the
/// points there were after as many frames, and, with a reference, reference.tum. \returns points of
/// the map \throws files::OutputError, also if something is in the folder
std::size_t save_estimate(const std::filesystem::path& folder, const geometry::Trajectory& estimate,
                          const MapHistory& map,
                          const std::optional<dataset::Reference>& reference);

}  // namespace traverse::replay
