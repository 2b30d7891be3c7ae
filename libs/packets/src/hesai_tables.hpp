#pragma once

#include <cstddef>

#include "hesai.hpp"

namespace traverse::packets {

/// When a channel of a Pandar128 fires after its block's time [us]; below zero: at that state of
/// the azimuth it does not.
/// \param near for a surface nearer than kPandar128Near_m
double pandar128_firing_us(std::size_t channel, std::size_t state, bool high_resolution, bool near);

inline constexpr double kPandar128Near_m = 2.85;

}  // namespace traverse::packets
