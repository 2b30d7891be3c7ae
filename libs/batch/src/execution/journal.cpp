#include "traverse/batch/journal.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "traverse/files/input_error.hpp"
#include "traverse/pipeline/provenance.hpp"

#include "execution/host_name.hpp"

namespace traverse::batch {

namespace {

using Json = nlohmann::ordered_json;

/// The last line of a killed process may have no end: what follows must not be glued to it.
void end_last_line(const std::filesystem::path& file, int descriptor) {
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  if (!stream || stream.tellg() <= 0) return;
  stream.seekg(-1, std::ios::end);
  if (stream.get() == '\n') return;
  if (::write(descriptor, "\n", 1) != 1) throw files::OutputError(file, std::strerror(errno));
}

JournalEntry entry_of(const Json& line) {
  JournalEntry entry;
  entry.utc = line.at("utc");
  entry.event = line.at("event");
  entry.host = line.at("host");
  entry.pid = line.value("pid", 0);
  entry.id = line.value("id", "");
  entry.outcome = line.value("outcome", "");
  entry.wall_s = line.value("wall_s", 0.0);
  entry.text = line.value("text", "");
  return entry;
}

}  // namespace

Journal::Journal(const std::filesystem::path& folder)
    : file_(folder / (host_name() + ".jsonl")), host_(host_name()) {
  descriptor_ = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor_ < 0) throw files::OutputError(file_, std::strerror(errno));
  end_last_line(file_, descriptor_);
}

Journal::~Journal() { ::close(descriptor_); }

void Journal::add(const JournalEntry& entry) {
  Json line{{"utc", pipeline::utc_now()}, {"event", entry.event}, {"host", host_}};
  if (entry.pid != 0) line["pid"] = entry.pid;
  if (!entry.id.empty()) line["id"] = entry.id;
  if (!entry.outcome.empty()) line["outcome"] = entry.outcome;
  if (entry.wall_s > 0) line["wall_s"] = entry.wall_s;
  if (!entry.text.empty()) line["text"] = entry.text;
  const std::string text = line.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  if (::write(descriptor_, text.data(), text.size()) != static_cast<ssize_t>(text.size())) {
    throw files::OutputError(file_, std::strerror(errno));
  }
}

void Journal::began(const std::string& text) {
  JournalEntry entry{.event = "began", .text = text};
  entry.pid = ::getpid();
  add(entry);
}

void Journal::started(const Job& job, int pid, int attempt) {
  JournalEntry entry{.event = "started", .id = job.id, .text = job.title()};
  entry.pid = pid;
  if (attempt > 1) entry.text += fmt::format(", attempt {}", attempt);
  add(entry);
}

void Journal::killed(const Job& job, int signal) {
  add({.event = "killed", .id = job.id, .outcome = fmt::format("signal {}", signal)});
}

void Journal::finished(const Job& job, const Completion& completion) {
  add({.event = "finished",
       .id = job.id,
       .outcome = std::string(name_of(completion.outcome)),
       .wall_s = completion.wall_s});
}

void Journal::ended(const std::string& text) {
  JournalEntry entry{.event = "ended", .text = text};
  entry.pid = ::getpid();
  add(entry);
}

std::vector<JournalEntry> read_journals(const std::filesystem::path& folder) {
  std::vector<JournalEntry> entries;
  std::error_code none;
  for (const auto& file : std::filesystem::directory_iterator(folder, none)) {
    if (file.path().extension() != ".jsonl") continue;
    std::ifstream stream(file.path());
    for (std::string text; std::getline(stream, text);) {
      const Json line = Json::parse(text, nullptr, /*allow_exceptions=*/false);
      try {
        entries.push_back(entry_of(line));
      } catch (const Json::exception&) {
        continue;  // half a line of a killed process, or somebody else's
      }
    }
  }
  std::stable_sort(entries.begin(), entries.end(),
                   [](const auto& a, const auto& b) { return a.utc < b.utc; });
  return entries;
}

}  // namespace traverse::batch
