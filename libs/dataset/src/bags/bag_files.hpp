#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "traverse/bags/message_container.hpp"
#include "traverse/dataset/source.hpp"

namespace traverse::dataset {

/// The files of a bag: itself, or those of a folder that are of one kind.
std::vector<std::filesystem::path> bag_files(const std::filesystem::path& path);

/// Opens them as one. A file of several that cannot be read is left out and told in `facts`.
/// \throws files::InputError if none can be read, or they are packed as whole files
std::unique_ptr<bags::MessageContainer> open_bag_files(const std::filesystem::path& path,
                                                       std::vector<Fact>& facts);

}  // namespace traverse::dataset
