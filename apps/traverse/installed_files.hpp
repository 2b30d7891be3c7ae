#pragma once

#include <filesystem>

namespace traverse::app {

/// Where the files that come with the program are: presets, sensor profiles, report templates.
///
/// Looked for in this order: the folder that the environment variable TRAVERSE_SHARE names, and
/// share/traverse beside the folder of the program. The build makes the latter of links, so that a
/// program that is built in place and an installed one look in the same way, and an installed one
/// knows of no source tree.
struct InstalledFiles {
  std::filesystem::path share;      ///< pipelines/, sensors/
  std::filesystem::path templates;  ///< report templates
};

/// \throws std::runtime_error listing the places looked at if none has them.
InstalledFiles find_installed_files();

}  // namespace traverse::app
