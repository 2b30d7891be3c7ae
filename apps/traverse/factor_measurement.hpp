#pragma once

#include <cstddef>

#include "traverse/dataset/source.hpp"
#include "traverse/loam/factor_bench.hpp"

namespace traverse::app {

/// Frames that are followed before the one that is measured, so that it meets a map.
inline constexpr std::size_t kFramesBefore = 10;

/// Repeats of each measurement unless others are asked for.
inline constexpr int kFactorRepeats = 51;

/// Measures the factors on the correspondences of frame `frame` of the recording, counted from 0.
/// Frames before it are followed from `first` on, at most kFramesBefore of them.
/// \throws std::runtime_error if the recording ends before it or has no lidar
loam::FactorBench measure_on_recording(dataset::Source& source, std::size_t first,
                                       std::size_t frame, int repeats);

/// The same on a simulated street.
loam::FactorBench measure_on_simulated_street(std::size_t frame, int repeats);

}  // namespace traverse::app
