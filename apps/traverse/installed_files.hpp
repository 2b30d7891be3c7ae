#pragma once

#include <filesystem>

namespace traverse::app {

/// Where the files that come with the program are: presets, sensor profiles, report templates.
///
/// Looked for in this order: the folder that the environment variable TRAVERSE_SHARE names,
/// share/traverse beside the program's bin folder (installed), and the source tree (built in
/// place).
struct InstalledFiles {
  std::filesystem::path share;      ///< pipelines/, sensors/
  std::filesystem::path templates;  ///< report templates
};

/// \throws std::runtime_error listing the places looked at if none has them.
InstalledFiles find_installed_files();

}  // namespace traverse::app
