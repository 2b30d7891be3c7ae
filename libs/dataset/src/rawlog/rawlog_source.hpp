#pragma once

#include <filesystem>
#include <memory>

#include "traverse/dataset/open_recording.hpp"

namespace traverse::dataset {

/// An MRPT rawlog, compressed or not. Facts about X.rawlog stand in X.traverse.yaml.
/// \throws files::InputError if the file cannot be read or holds no observation that is used.
std::unique_ptr<Source> open_rawlog(const std::filesystem::path& file, const OpenOptions& options);

}  // namespace traverse::dataset
