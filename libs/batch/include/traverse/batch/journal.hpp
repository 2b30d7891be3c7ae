#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "traverse/batch/completion.hpp"
#include "traverse/batch/job.hpp"

namespace traverse::batch {

/// One line of a journal.
struct JournalEntry {
  std::string utc{};    ///< "2026-11-22T10:15:30Z"
  std::string event{};  ///< "began", "started", "killed", "finished", "ended"
  std::string host{};
  int pid = 0;            ///< began, ended: of the batch; started: of the run
  std::string id{};       ///< of the run: started, killed, finished
  std::string outcome{};  ///< finished; killed: "signal 9"
  double wall_s = 0;      ///< finished
  std::string text{};     ///< for people: the run's title, what the batch does
};

/// What happened, as it happened: one JSON object a line, appended in one write, so that a process
/// that is killed leaves at most one line cut off, which readers leave out. Each host has its own
/// file, because appending to one file from several hosts is not safe on NFS. The journal is for
/// people and for `status`; what counts as finished is decided by the runs' own records.
class Journal {
 public:
  /// \throws files::OutputError
  explicit Journal(const std::filesystem::path& folder);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  void began(const std::string& text);
  void started(const Job& job, int pid, int attempt);
  void killed(const Job& job, int signal);
  void finished(const Job& job, const Completion& completion);
  void ended(const std::string& text);

 private:
  void add(const JournalEntry& entry);

  std::filesystem::path file_;
  std::string host_;
  int descriptor_;
};

/// All entries of all hosts, by time. Lines that are cut off are left out.
std::vector<JournalEntry> read_journals(const std::filesystem::path& folder);

}  // namespace traverse::batch
