#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "traverse/evaluation/checkpoints.hpp"
#include "traverse/evaluation/worst_segments.hpp"
#include "traverse/pipeline/run_contents.hpp"

namespace traverse::report {

/// A run folder, read and checked.
struct RunData : pipeline::RunContents {
  nlohmann::json record;  ///< run.json
  /// Residuals at surveyed points, where the run was held against them.
  std::optional<evaluation::CheckpointEvaluation> checkpoints = {};

  std::string recording_name() const { return record.at("recording").at("name"); }
  std::string pipeline_name() const { return record.at("pipeline"); }
  /// Whether run.json does not tell whose machine it was made on.
  bool is_private() const { return record.value("private", false); }
  std::string date() const { return std::string(record.at("started_utc")).substr(0, 10); }
};

/// Takes from what pages are made of whose machine it was: paths, its name, its processor.
/// \param place of the folder, from which paths are told
void make_private(RunData& run, const std::filesystem::path& place);

/// \throws files::InputError as pipeline::read_run()
RunData read_run(const std::filesystem::path& folder, pipeline::RunPart part);

}  // namespace traverse::report
