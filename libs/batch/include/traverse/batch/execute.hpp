#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>

#include "traverse/batch/batch_folder.hpp"
#include "traverse/batch/completion.hpp"
#include "traverse/batch/job.hpp"
#include "traverse/batch/journal.hpp"

namespace traverse::batch {

/// What a run is executed with.
struct ExecutionContext {
  std::filesystem::path program;  ///< this program
  BatchFolder folder;
  Journal& journal;
  const std::atomic<bool>& stop;
};

/// Where the log of a job that is being run by this process stands.
std::filesystem::path log_in_work(const BatchFolder& folder, const Job& job);

/// Runs the job in a process of its own, within its limits, and makes it finished: the run works in
/// a folder of a temporary name, which gets its record and then, by one rename, its name. A run
/// that something outside killed is begun again, as often as its limits allow.
/// \returns nothing if it was stopped
/// \throws files::OutputError, std::system_error
std::optional<Completion> execute(const Job& job, const ExecutionContext& context);

/// Takes a finished run away, whole, so that it is made again. \throws files::OutputError
void discard(const BatchFolder& folder, const Job& job);

/// Removes what killed batches of this host left of runs. Those of other hosts are left alone.
void remove_abandoned(const BatchFolder& folder);

}  // namespace traverse::batch
