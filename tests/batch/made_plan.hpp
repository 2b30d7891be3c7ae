#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "traverse/batch/completion.hpp"
#include "traverse/batch/job.hpp"
#include "traverse/batch/plan.hpp"
#include "traverse/files/atomic_file.hpp"

#include "temporary_folder.hpp"

namespace traverse::batch {

/// Any simulation begins.
inline std::optional<std::string> no_error(const std::vector<std::string>&) { return std::nullopt; }

/// Writes `yaml` as a plan in the folder and reads it.
inline Plan plan_of(const testing::TemporaryFolder& folder, const std::string& yaml) {
  files::write_text(folder / "plan.yaml", yaml);
  return load_plan(folder / "plan.yaml", TRAVERSE_SHARE_DIR, no_error);
}

/// A job of that name and setting, and the record of its run.
inline Job made_job(const std::string& recording, const std::string& pipeline, int repeat = 1) {
  Job job;
  job.recording = recording;
  job.pipeline = pipeline;
  job.repeat = repeat;
  job.id = recording + "." + pipeline + "." + std::to_string(repeat) + "................";
  return job;
}

inline Completion made_completion(const Job& job, const std::vector<MetricValue>& metrics,
                                  Outcome outcome = Outcome::kOk) {
  Completion completion;
  completion.id = job.id;
  completion.outcome = outcome;
  completion.metrics = metrics;
  return completion;
}

}  // namespace traverse::batch
