#pragma once

#include "traverse/files/json_document.hpp"
#include "traverse/geometry/trajectory.hpp"
#include "traverse/pipeline/frame_table.hpp"
#include "traverse/pipeline/run_folder.hpp"

namespace traverse::pipeline {

/// That frames.csv has a row for each pose, with its stamp and the number that run.json counts it
/// by; every column that goes with another one; and in columns of counts and times such.
/// \param record run.json, checked \throws files::InputError
void require_frames(const FrameTable& frames, const geometry::Trajectory& estimate,
                    const files::JsonValue& record, const RunFolder& folder);

}  // namespace traverse::pipeline
