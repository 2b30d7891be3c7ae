#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "traverse/batch/batch_folder.hpp"

namespace traverse::batch {

/// What can be told of a batch from its folder alone, by any process on any machine that sees it.
struct BatchStatus {
  std::size_t distinct = 0;  ///< runs of the plan
  std::size_t finished = 0;
  std::map<std::string, std::size_t> outcomes;  ///< name: runs
  struct Running {
    std::string title;
    std::string host;
    double seconds = 0;
  };
  std::vector<Running> running;
  bool at_work = false;        ///< a batch on this machine holds the folder's lock
  double runs_per_second = 0;  ///< of the last stretch of work; 0 if nothing is known
  double seconds_left = 0;     ///< at that rate; 0 if nothing is known
  std::string last_event_utc;  ///< of the journals
};

/// \throws files::InputError if the folder is not that of a batch.
BatchStatus read_status(const BatchFolder& folder);

/// Ends a local batch that is at work in the folder, in order. \returns false if there is none on
/// this machine.
bool cancel_local(const BatchFolder& folder);

}  // namespace traverse::batch
