#pragma once

#include <nlohmann/json.hpp>

#include "traverse/files/json_document.hpp"
#include "traverse/pipeline/run_health.hpp"

namespace traverse::pipeline {

/// "health" of run.json.
nlohmann::ordered_json to_json(const RunHealth& health);

/// Reads it back. \throws files::InputError naming the key
RunHealth health_from_json(const files::JsonValue& json);

}  // namespace traverse::pipeline
