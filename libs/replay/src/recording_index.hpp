#pragma once

#include <optional>

#include "traverse/replay/frame_index.hpp"
#include "traverse/replay/recording.hpp"

namespace traverse::replay {

/// The index of a recording: listed by its format, else kept from an earlier time, else built.
/// \param keep look for it in the user's cache folder, and leave it there
/// \returns nothing if the observer stopped it  \throws files::InputError, files::OutputError
std::optional<FrameIndex> index_of(const Recording& recording, bool keep,
                                   const IndexObserver& observer);

}  // namespace traverse::replay
