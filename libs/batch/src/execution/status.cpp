#include "traverse/batch/status.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <ctime>
#include <set>
#include <system_error>

#include "traverse/batch/job.hpp"
#include "traverse/batch/journal.hpp"
#include "traverse/files/numbers.hpp"
#include "traverse/files/text_file.hpp"

#include "execution/host_name.hpp"
#include "execution/lock.hpp"

namespace traverse::batch {

namespace {

namespace fs = std::filesystem;

/// "2026-11-22T10:15:30Z" as seconds since 1970; 0 if it is not such a text.
double seconds_of(const std::string& utc) {
  std::tm time{};
  if (::strptime(utc.c_str(), "%Y-%m-%dT%H:%M:%SZ", &time) == nullptr) return 0;
  return static_cast<double>(::timegm(&time));
}

bool is_batch_lock(const fs::path& file) {
  const std::string name = file.filename().string();
  return name == "lock" || name.starts_with("lock.");
}

std::vector<fs::path> held_locks(const BatchFolder& folder) {
  std::vector<fs::path> held;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder.path, none)) {
    if (is_batch_lock(entry.path()) && BatchLock::is_held(entry.path())) {
      held.push_back(entry.path());
    }
  }
  return held;
}

/// A process of this machine can be asked; of another one it is believed.
bool may_be_alive(const JournalEntry& started) {
  return started.host != host_name() || ::kill(started.pid, 0) == 0;
}

void add_running(const std::vector<JournalEntry>& journal, BatchStatus& status) {
  std::map<std::string, const JournalEntry*> open;
  for (const JournalEntry& entry : journal) {
    if (entry.event == "started") open[entry.id] = &entry;
    if (entry.event == "killed" || entry.event == "finished") open.erase(entry.id);
  }
  const auto now = static_cast<double>(std::time(nullptr));
  for (const auto& [id, entry] : open) {
    if (!may_be_alive(*entry)) continue;
    status.running.push_back({entry->text, entry->host, now - seconds_of(entry->utc)});
  }
}

/// Rate since the last batch began.
void add_rate(const std::vector<JournalEntry>& journal, BatchStatus& status) {
  const auto began = std::find_if(journal.rbegin(), journal.rend(),
                                  [](const auto& entry) { return entry.event == "began"; });
  if (began == journal.rend()) return;
  const auto made = std::count_if(journal.rbegin(), began,
                                  [](const auto& entry) { return entry.event == "finished"; });
  const double seconds = seconds_of(status.last_event_utc) - seconds_of(began->utc);
  if (made == 0 || seconds <= 0) return;
  status.runs_per_second = static_cast<double>(made) / seconds;
  status.seconds_left =
      static_cast<double>(status.distinct - status.finished) / status.runs_per_second;
}

}  // namespace

BatchStatus read_status(const BatchFolder& folder) {
  BatchStatus status;
  std::set<std::string> names;
  for (const Job& job : read_jobs(folder.jobs())) names.insert(BatchFolder::run_name(job.id));
  status.distinct = names.size();
  const std::vector<JournalEntry> journal = read_journals(folder.journals());
  std::map<std::string, std::string> outcomes;
  for (const JournalEntry& entry : journal) {
    status.last_event_utc = entry.utc;
    if (entry.event == "finished") outcomes[BatchFolder::run_name(entry.id)] = entry.outcome;
  }
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder.runs(), none)) {
    const std::string name = entry.path().filename().string();
    if (!names.contains(name)) continue;
    ++status.finished;
    // A batch killed between a run's rename and its line has the run without the line.
    const auto known = outcomes.find(name);
    ++status.outcomes[known != outcomes.end() ? known->second : "finished"];
  }
  add_running(journal, status);
  add_rate(journal, status);
  status.at_work = !held_locks(folder).empty();
  return status;
}

bool cancel_local(const BatchFolder& folder) {
  bool asked = false;
  for (const fs::path& lock : held_locks(folder)) {
    // "process 4711 on HOST since ..."
    const std::string owner = files::read_text(lock);
    const auto words = files::split_words(owner);
    if (words.size() < 4 || words[3] != host_name()) continue;
    const auto pid = files::parse_integer(words[1]);
    // Not SIGINT, which the background jobs of a script ignore.
    asked |= pid && ::kill(static_cast<pid_t>(*pid), SIGTERM) == 0;
  }
  return asked;
}

}  // namespace traverse::batch
