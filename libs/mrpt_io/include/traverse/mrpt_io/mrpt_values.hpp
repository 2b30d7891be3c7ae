#pragma once

#include <exception>
#include <optional>
#include <string>

#include <mrpt/core/Clock.h>
#include <mrpt/poses/CPose3D.h>

#include "traverse/geometry/pose3.hpp"
#include "traverse/geometry/stamp.hpp"

/// MRPT's values as ours and back.
namespace traverse::mrpt_io {

/// MRPT counts ticks of 100 ns since 1601. Nothing for its "invalid" and for what a Stamp cannot
/// hold.
std::optional<geometry::Stamp> to_stamp(mrpt::Clock::time_point time);
/// To the nearest tick.
mrpt::Clock::time_point to_mrpt(geometry::Stamp stamp);

geometry::Pose3 to_pose(const mrpt::poses::CPose3D& pose);
mrpt::poses::CPose3D to_mrpt(const geometry::Pose3& pose);

/// A flag as MRPT read it from a file, where it may be any byte; only 1 is yes.
bool is_set(const bool& flag);

/// What an MRPT exception says, without its place in the source and its call stack.
std::string message_of(const std::exception& error);

}  // namespace traverse::mrpt_io
