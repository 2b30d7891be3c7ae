#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "traverse/dataset/open_recording.hpp"

namespace traverse::dataset {

/// An MRPT rawlog, compressed or not. Facts about X.rawlog stand in X.traverse.yaml.
/// \param format the name of it, see recording_formats.hpp
/// \throws files::InputError if the file cannot be read or holds no observation that is used.
std::unique_ptr<Source> open_rawlog(const std::filesystem::path& file, const OpenOptions& options,
                                    std::string_view format);

}  // namespace traverse::dataset
