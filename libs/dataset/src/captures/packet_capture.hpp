#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "traverse/dataset/open_recording.hpp"

namespace traverse::dataset {

/// Whether the file is a capture of a network by its name or its first bytes.
bool is_packet_capture(const std::filesystem::path& file);

/// Opens a capture (.pcap, .pcapng) of lidars' packets: Velodyne, Hesai, and an Ouster whose
/// metadata are stated (lidar.metadata) or the only ones of a *.json beside it.
/// \param format the name of it, see recording_formats.hpp
/// \throws files::InputError if no packet of a known lidar is near its beginning
std::unique_ptr<Source> open_packet_capture(const std::filesystem::path& file,
                                            const OpenOptions& options, std::string_view format);

}  // namespace traverse::dataset
