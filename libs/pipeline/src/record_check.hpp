#pragma once

#include "traverse/files/json_document.hpp"

namespace traverse::pipeline {

/// That run.json has what its readers rely on: every key, each of its kind, and figures that a run
/// can have. \throws files::InputError naming the file and the key
void require_run_record(const files::JsonValue& record);

/// Whether the run was assessed: older ones were not, and those without a frame cannot be.
bool has_health(const files::JsonValue& record);

/// Whether its poses were made by another program.
bool is_foreign_run(const files::JsonValue& record);

}  // namespace traverse::pipeline
