#pragma once

namespace traverse::batch {

/// Where a run writes to in the folder that it works in: its log stands beside, and a run refuses a
/// folder in which something is.
inline constexpr const char* kRunOutput = "run";

}  // namespace traverse::batch
