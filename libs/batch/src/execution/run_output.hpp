#pragma once

namespace traverse::batch {

/// Where a run writes to in the folder that it works in: its log stands beside, and a run refuses a
/// folder in which something is.
inline constexpr const char* kRunOutput = "run";

/// Where a program that is not ours works, in the same folder; and what its run cost, as
/// `traverse import --timing` reads it.
inline constexpr const char* kCommandFolder = "system";
inline constexpr const char* kCommandCost = "system.yaml";

}  // namespace traverse::batch
