#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "traverse/geometry/stamp.hpp"
#include "traverse/mapping/map_keyframe.hpp"

namespace traverse::mapping {

/// A map as points, of each voxel the first one, with what is known of each.
struct MapPoints {
  std::vector<float> x, y, z;           ///< metres, map frame
  std::vector<float> intensity;         ///< 0 .. 1
  std::vector<geometry::Stamp> stamp;   ///< when it was seen
  std::vector<std::uint16_t> ring;      ///< as the recording counts them; kNoRing
  std::vector<std::uint32_t> keyframe;  ///< number of that keyframe, from 0
  std::vector<std::uint16_t> run;       ///< of several runs, from 0

  static constexpr std::uint16_t kNoRing = 0xffff;  ///< the keyframe does not know

  std::size_t size() const { return x.size(); }
};

/// \param voxel_m of the points in a cube of this edge the first is kept
MapPoints map_points(std::span<const MapKeyframe> keyframes, double voxel_m);

/// As binary PLY: x, y, z, intensity, and with attributes also time (double), ring (ushort; where
/// any is known) and keyframe (uint).
/// \throws files::OutputError
void write_ply(const std::filesystem::path& file, const MapPoints& points, bool with_attributes);

}  // namespace traverse::mapping
