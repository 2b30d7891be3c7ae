#pragma once

#include <cstddef>
#include <cstdint>

#include "traverse/packets/packet_decoder.hpp"

namespace traverse::packets {

constexpr std::size_t kVelodyneReturns = 32;     // of a block
constexpr std::size_t kVelodyneReturnBytes = 3;  // distance in units, 16 bits, and intensity, 8

/// The lasers of a block, from the first of its bank on, each an array of kVelodyneReturns.
struct BlockBeams {
  const float* sin_azimuth;  ///< with what the head has turned since the block's azimuth
  const float* cos_azimuth;
  const float* sin_elevation;
  const float* cos_elevation;
  const float* distance_m;  ///< added to what was measured
  const float* delay_us;    ///< after the block's begin
  const std::uint16_t* ring;
  /// Where the laser leaves the sensor, across its azimuth and upwards; null where it is in the
  /// axis.
  const float* horizontal_m;
  const float* vertical_m;
};

struct BlockHead {
  float sin, cos;  ///< of its azimuth
  float unit_m;    ///< that a distance of 1 means
  float begin_s;   ///< after the scan's stamp
};

/// Where points go: one after the other, with room for kBlockSpill beyond the last.
struct PointColumns {
  float *x, *y, *z, *intensity, *time;
  std::uint16_t* ring;
};
constexpr std::size_t kBlockSpill = 8;

/// Makes points of the returns of a block that have a distance, in their order.
/// \param returns kVelodyneReturns of them; 8 bytes behind the last can be read
/// \param first of the same firings, where `returns` are second ones: those at the same distance
/// are
///        one and the same and become no point twice; else null
/// \returns how many came in and how many points went out, the same bits on any processor
ReturnCounts decode_block(const BlockHead& head, const BlockBeams& beams,
                          const std::uint8_t* returns, const std::uint8_t* first,
                          const PointColumns& to);

/// The same on a processor without AVX2.
ReturnCounts decode_block_one_by_one(const BlockHead& head, const BlockBeams& beams,
                                     const std::uint8_t* returns, const std::uint8_t* first,
                                     const PointColumns& to);

}  // namespace traverse::packets
