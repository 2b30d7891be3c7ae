#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "traverse/geodesy/local_tangent_plane.hpp"
#include "traverse/mapping/map_keyframe.hpp"
#include "traverse/pipeline/run_folder.hpp"
#include "traverse/slam/keyframe_file.hpp"

namespace traverse::pipeline {

/// The keyframes that a map is made of. Those of a folder with run.json must belong to its frames.
/// \param run folder of a run or of a map, or an MRPT simple map
/// \throws files::InputError naming the file and the keyframe, and as read_run()
std::vector<mapping::MapKeyframe> read_map_keyframes(const std::filesystem::path& run);

/// The keyframes in which a recording can be followed. \param file keyframes.simplemap of a run
/// \throws as read_map_keyframes()
std::vector<slam::MapKeyframe> read_localization_map(const std::filesystem::path& file);

/// Where on earth the map of a run is, if its frame is ENU. \throws files::InputError
std::optional<geodesy::Geodetic> read_origin(const RunFolder& folder);

}  // namespace traverse::pipeline
