#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "traverse/evaluation/worst_segments.hpp"
#include "traverse/pipeline/run_contents.hpp"

namespace traverse::report {

/// A run folder, read and checked.
struct RunData : pipeline::RunContents {
  nlohmann::json record;  ///< run.json

  std::string recording_name() const { return record.at("recording").at("name"); }
  std::string pipeline_name() const { return record.at("pipeline"); }
  std::string date() const { return std::string(record.at("started_utc")).substr(0, 10); }
};

/// \throws files::InputError as pipeline::read_run()
RunData read_run(const std::filesystem::path& folder, pipeline::RunPart part);

}  // namespace traverse::report
