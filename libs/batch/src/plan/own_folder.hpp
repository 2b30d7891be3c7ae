#pragma once

#include <string>

#include "traverse/batch/batch_folder.hpp"

namespace traverse::batch {

/// A batch writes over files of BatchFolder's names only where one has worked before, which its
/// journal tells. Other files in the folder are in nobody's way.
/// \param plan its text: the plan may be read from the place where it is kept
/// \throws files::OutputError naming a file that is there and is somebody else's.
void require_own_folder(const BatchFolder& folder, const std::string& plan);

}  // namespace traverse::batch
