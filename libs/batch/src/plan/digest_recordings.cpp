#include <algorithm>
#include <chrono>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/digest.hpp"
#include "traverse/files/json_document.hpp"

#include "plan/recordings.hpp"

namespace traverse::batch {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// A file of a recording and what it is called in the digest.
struct NamedFile {
  std::string name;
  fs::path path;
};

void add_below(const fs::path& folder, const std::string& prefix, std::vector<NamedFile>& files) {
  const auto options = fs::directory_options::follow_directory_symlink;
  for (const auto& entry : fs::recursive_directory_iterator(folder, options)) {
    if (!entry.is_regular_file()) continue;
    files.push_back(
        {prefix + entry.path().lexically_relative(folder).generic_string(), entry.path()});
  }
}

/// drive.rawlog and what shares its name: drive.traverse.yaml, drive_Images/.
void add_siblings(const fs::path& file, std::vector<NamedFile>& files) {
  const std::string stem = file.stem().string();
  for (const auto& entry : fs::directory_iterator(file.parent_path())) {
    const std::string name = entry.path().filename().string();
    if (entry.is_regular_file() && name.starts_with(stem + ".")) {
      files.push_back({name, entry.path()});
    } else if (entry.is_directory() && name.starts_with(stem + "_")) {
      add_below(entry.path(), name + "/", files);
    }
  }
}

std::vector<NamedFile> files_of(const PlannedRecording& recording) {
  std::vector<NamedFile> files;
  if (fs::is_directory(recording.path)) {
    add_below(recording.path, "", files);
  } else {
    add_siblings(recording.path, files);
  }
  if (!recording.statements_file.empty()) {
    files.push_back({"statements:", recording.statements_file});
  }
  if (!recording.reference.empty()) files.push_back({"reference:", recording.reference});
  std::sort(files.begin(), files.end(),
            [](const NamedFile& a, const NamedFile& b) { return a.name < b.name; });
  return files;
}

/// Names, sizes and times of change: the same as long as nobody wrote to the files.
std::string fingerprint(const std::vector<NamedFile>& files) {
  std::string text;
  for (const NamedFile& file : files) {
    text += fmt::format("{} {} {}\n", file.path.string(), fs::file_size(file.path),
                        fs::last_write_time(file.path).time_since_epoch().count());
  }
  return files::sha256_of_text(text);
}

std::string digest(const std::vector<NamedFile>& files) {
  std::string text;
  for (const NamedFile& file : files) {
    text += files::sha256_of_file(file.path) + "  " + file.name + "\n";
  }
  return files::sha256_of_text(text);
}

/// What an earlier call found; nothing of a file that is not one of ours.
json read_known(const fs::path& file) {
  std::error_code none;
  if (!fs::exists(file, none)) return json::object();
  try {
    json known = json::object();
    const auto document = files::JsonDocument::read(file);
    const files::JsonValue root = document.root();
    for (const std::string& name : root.keys()) {
      known[name] = {{"path", root[name]["path"].text()},
                     {"files", root[name]["files"].count()},
                     {"fingerprint", root[name]["fingerprint"].text()},
                     {"sha256", root[name]["sha256"].text()}};
    }
    return known;
  } catch (const files::InputError&) {
    return json::object();
  }
}

}  // namespace

RecordingDigests digest_recordings(const Plan& plan, const BatchFolder& folder,
                                   const std::function<void(const std::string& name)>& reading) {
  const json known = read_known(folder.digests());
  json present = json::object();
  RecordingDigests digests;
  for (const PlannedRecording& recording : plan.recordings) {
    const std::vector<NamedFile> files = files_of(recording);
    const std::string fingerprint_now = fingerprint(files);
    const auto found = known.find(recording.name);
    const bool same = found != known.end() && found->value("fingerprint", "") == fingerprint_now;
    if (!same) reading(recording.name);
    const std::string sha256 = same ? found->value("sha256", "") : digest(files);
    digests[recording.name] = sha256;
    present[recording.name] = {{"path", recording.path.string()},
                               {"files", files.size()},
                               {"fingerprint", fingerprint_now},
                               {"sha256", sha256}};
  }
  if (present != known) files::write_text(folder.digests(), present.dump(1) + "\n");
  return digests;
}

}  // namespace traverse::batch
