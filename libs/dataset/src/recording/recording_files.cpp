#include "recording/recording_files.hpp"

#include <algorithm>
#include <fstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"

namespace traverse::dataset {

namespace {

namespace fs = std::filesystem;

constexpr const char* kStatements = "traverse.yaml";
constexpr std::string_view kHeading =
    "# Written by traverse together with these files, which it replaces when it writes them again:";
constexpr std::string_view kEntry = "#   ";

bool is_in_the_way(const fs::path& file) {
  std::error_code failure;
  return fs::exists(fs::symlink_status(file, failure));
}

/// What the heading of such a file lists; nothing if it is not one of ours.
std::set<std::string> listed_in(const fs::path& statements) {
  std::set<std::string> names;
  std::ifstream stream(statements);
  std::string line;
  if (!std::getline(stream, line) || line != kHeading) return names;
  while (std::getline(stream, line) && line.starts_with(kEntry)) {
    names.insert(line.substr(kEntry.size()));
  }
  return names;
}

/// One line in a comment whatever the name holds; a name that had to be changed matches no file.
std::string on_one_line(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '\n' || c == '\r'; }, '?');
  return name;
}

}  // namespace

RecordingFiles::RecordingFiles(fs::path folder, std::string prefix, FilesThere there)
    : folder_(std::move(folder)), prefix_(std::move(prefix)), there_(std::move(there)) {}

RecordingFiles RecordingFiles::beside(const fs::path& data, const FilesThere& there) {
  RecordingFiles files(data.parent_path(), data.stem().string() + ".", there);
  files.data_ = data.filename().string();
  const std::string statements = files.full_name(kStatements);
  const std::set<std::string> listed = listed_in(files.folder_ / statements);
  if (listed.contains(files.data_)) {
    files.earlier_ = listed;
    files.earlier_.insert(statements);
  } else if (!listed.empty()) {
    throw files::OutputError(
        data, fmt::format("{} belongs to {}, which must keep it. Choose another name",
                          (files.folder_ / statements).string(), *listed.begin()));
  }
  files.require_own(files.data_);
  for (const char* name : {kStatements, "reference.tum", "calib.txt"}) {
    files.require_own(files.full_name(name));
  }
  for (const std::string& name : there.others) files.require_own(files.full_name(name));
  return files;
}

RecordingFiles RecordingFiles::within(const fs::path& folder) { return {folder, "", {}}; }

void RecordingFiles::require_own(const std::string& full_name) const {
  const fs::path file = folder_ / full_name;
  std::error_code failure;
  if (there_.replace || earlier_.contains(full_name) || !is_in_the_way(file) ||
      fs::is_other(file, failure)) {
    return;
  }
  throw files::OutputError(
      file, fmt::format("it is there already, and {} does not say that this program wrote it. "
                        "Choose another name, or let --force replace it",
                        this->full_name(kStatements)));
}

files::AtomicFile& RecordingFiles::add(const std::string& name) {
  names_.push_back(full_name(name));
  return files_.add(folder_ / names_.back());
}

void RecordingFiles::write(const std::string& name, std::string_view text) {
  names_.push_back(full_name(name));
  files_.write(folder_ / names_.back(), text);
}

files::AtomicFile& RecordingFiles::add_data() {
  names_.push_back(data_);
  return files_.add(folder_ / data_);
}

std::string RecordingFiles::heading() const {
  if (data_.empty()) return "# Written by traverse beside the recording.\n";
  std::string text = fmt::format("{}\n", kHeading);
  for (const std::string& name : names_) text += fmt::format("{}{}\n", kEntry, on_one_line(name));
  return text;
}

void RecordingFiles::commit(const std::string& statements) {
  const std::string text = heading() + statements;
  write(kStatements, text);
  for (const std::string& name : names_) {
    if (!data_.empty()) require_own(name);  // what has come there meanwhile
  }
  files_.commit();
  for (const std::string& name : earlier_) {
    std::error_code ignored;
    if (std::find(names_.begin(), names_.end(), name) == names_.end()) {
      fs::remove(folder_ / name, ignored);
    }
  }
}

}  // namespace traverse::dataset
