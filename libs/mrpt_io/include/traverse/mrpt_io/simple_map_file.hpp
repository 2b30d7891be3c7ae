#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>

#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDF.h>
#include <mrpt/serialization/CArchive.h>

/// Simple maps (mrpt::maps::CSimpleMap) as files, one keyframe after the other: MRPT itself has
/// either none or all of them in memory.
namespace traverse::mrpt_io {

/// Writes the file that mrpt::maps::CSimpleMap::saveToFile() writes, byte for byte before
/// compression, and makes sure that every byte is on disk.
/// \param write puts keyframe i into the archive: archive << pose << frame
/// \throws files::OutputError
void write_simple_map(
    const std::filesystem::path& file, std::size_t keyframes,
    const std::function<void(mrpt::serialization::CArchive& archive, std::size_t i)>& write);

/// Reads any simple map of MRPT. \param take is given each keyframe in turn
/// \returns how many there were
/// \throws files::InputError if the file is no simple map or damaged, or a pose is not finite or
/// beyond any drive, and what `take` throws
std::size_t for_each_keyframe(
    const std::filesystem::path& file,
    const std::function<void(std::size_t i, const mrpt::poses::CPose3DPDF& pose,
                             const mrpt::obs::CSensoryFrame& frame)>& take);

/// That the points of a keyframe are finite and as near as a lidar sees.
/// \param record number of the keyframe \throws files::InputError
void require_points_in_sight(const std::filesystem::path& file, std::size_t record,
                             std::span<const float> x, std::span<const float> y,
                             std::span<const float> z);

}  // namespace traverse::mrpt_io
