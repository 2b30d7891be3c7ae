#pragma once

#include "traverse/files/json_document.hpp"

namespace traverse::pipeline {

/// That run.json has what its readers rely on: every key, each of its kind, and figures that a run
/// can have. \throws files::InputError naming the file and the key
void require_run_record(const files::JsonValue& record);

}  // namespace traverse::pipeline
