#pragma once

#include <filesystem>

#include "recording/folder_source.hpp"
#include "recording/statements.hpp"

namespace traverse::dataset {

/// Adds IMU, receiver and wheels of the CSV tables beside the scans of `folder`, which are stated
/// or known by name and header, with the reference that they hold if there is no other. Their
/// stamps are on the clock of the scans'. \throws files::InputError if stated tables cannot be read
void add_tables(FolderRecording& recording, const std::filesystem::path& folder,
                const Statements& statements);

}  // namespace traverse::dataset
