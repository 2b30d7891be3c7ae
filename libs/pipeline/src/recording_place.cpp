#include "traverse/pipeline/recording_place.hpp"

#include <system_error>

#include <nlohmann/json.hpp>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/json_document.hpp"
#include "traverse/files/sealed_json.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/pipeline/run_folder.hpp"

namespace traverse::pipeline {

namespace {

namespace fs = std::filesystem;

fs::path plain(const fs::path& path) {
  if (path.empty()) return path;
  const fs::path whole = fs::absolute(path).lexically_normal();
  return whole.has_filename() ? whole : whole.parent_path();
}

/// Without links on the way, since ".." leads out of the folder that a link names. The last name
/// stays, as what stands beside the recording stands beside the link.
fs::path without_links_before(const fs::path& path) {
  std::error_code failure;
  const fs::path folder = fs::weakly_canonical(path.parent_path(), failure);
  return failure ? path : folder / path.filename();
}

}  // namespace

RecordingPlace recording_place(const fs::path& recording, const fs::path& run_folder) {
  RecordingPlace place;
  place.path = plain(recording);
  if (recording.empty() || run_folder.empty()) return place;
  std::error_code failure;
  const fs::path folder = fs::weakly_canonical(plain(run_folder), failure);
  if (!failure) place.from_run = without_links_before(place.path).lexically_relative(folder);
  return place;
}

fs::path find_recording(const RunFolder& folder, const files::JsonValue& record) {
  const files::JsonValue recording = record["recording"];
  const fs::path told = recording["path"].text();
  std::error_code failure;
  if (told.is_absolute() && fs::exists(told, failure)) return told;
  if (recording.has("path_from_run") && recording["path_from_run"].is_text()) {
    const fs::path from_run = recording["path_from_run"].text();
    const fs::path there = fs::weakly_canonical(fs::absolute(folder.path), failure) / from_run;
    if (fs::exists(there, failure)) return there.lexically_normal();
  }
  return told;
}

void retell_place(const RunFolder& folder, const fs::path& from, const fs::path& to) {
  if (!fs::is_regular_file(folder.record())) return;
  nlohmann::ordered_json record;
  try {
    const std::string text = files::read_text(folder.record());
    if (!files::require_seal(text, folder.record())) return;
    record = nlohmann::ordered_json::parse(text);
  } catch (const files::InputError&) {
    return;  // a run that crashed while it wrote
  }
  if (!record.contains("recording")) return;
  auto& recording = record["recording"];
  std::error_code failure;
  const fs::path before = fs::weakly_canonical(plain(from), failure);
  const fs::path now = fs::weakly_canonical(plain(to), failure);
  const auto move = [&](const char* key) {
    if (!recording.contains(key) || !recording[key].is_string()) return;
    const fs::path told = recording[key].get<std::string>();
    // A name alone is told where the way there is not.
    if (told.is_absolute() || !told.has_parent_path()) return;
    recording[key] = (before / told).lexically_normal().lexically_relative(now).string();
  };
  move("path");
  move("path_from_run");
  record.erase(std::string(files::kSealKey));
  files::write_text(
      folder.record(),
      files::sealed_json(record.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) +
                         "\n"));
}

}  // namespace traverse::pipeline
