#pragma once

#include <string>
#include <string_view>

#include "traverse/bags/container_writer.hpp"

namespace traverse::bags {

/// Packs `text` into `packed`, whose room is used again. Lz4 is the frame format as ROS 1 reads it:
/// independent blocks and no size. \throws NoLibrary
void pack(ChunkPacking packing, std::string_view text, std::string& packed);

}  // namespace traverse::bags
