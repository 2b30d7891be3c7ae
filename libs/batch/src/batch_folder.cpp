#include "traverse/batch/batch_folder.hpp"

#include <fstream>
#include <system_error>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"

namespace traverse::batch {

namespace {

namespace fs = std::filesystem;

/// It is made before anything else is written.
bool has_journal(const fs::path& folder) {
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (entry.path().extension() == ".jsonl") return true;
  }
  return false;
}

std::string first_bytes(const fs::path& file, std::size_t count) {
  std::ifstream stream(file, std::ios::binary);
  std::string text(count, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(count));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

}  // namespace

void BatchFolder::require_own(const std::string& plan_text) const {
  if (has_journal(journals())) return;
  std::error_code failure;
  for (const fs::path& place :
       {plan(), jobs(), digests(), results_csv(), results_json(), leaderboard_tex(), report(),
        recordings(), runs(), journals(), submissions(), path / "lock"}) {
    if (!fs::exists(fs::symlink_status(place, failure))) continue;
    if (fs::is_directory(place, failure) && fs::is_empty(place, failure)) continue;
    if (fs::is_regular_file(place, failure)) {
      const std::string text = first_bytes(place, plan_text.size() + 1);
      if (place == plan() && text == plan_text) continue;
      if (place == path / "lock" && (text.empty() || text.starts_with("process "))) continue;
    }
    throw files::OutputError(
        place,
        "it is there already, and no batch has worked in this folder (journal/ is empty). "
        "Choose another folder");
  }
}

void BatchFolder::prepare() const {
  files::make_writable_folder(path);
  for (const auto& folder : {recordings(), runs(), journals()}) {
    files::make_writable_folder(folder);
  }
}

}  // namespace traverse::batch
