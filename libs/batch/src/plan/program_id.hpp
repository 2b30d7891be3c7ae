#pragma once

#include <filesystem>
#include <string>

namespace traverse::batch {

/// What the program is, as far as results depend on it: version and commit. A build of changed
/// sources has no commit of its own: then the digests of the program's file and of its presets and
/// sensor profiles are added.
std::string program_id(const std::filesystem::path& program,
                       const std::filesystem::path& share_folder);

}  // namespace traverse::batch
