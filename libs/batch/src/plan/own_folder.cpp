#include "plan/own_folder.hpp"

#include <fstream>
#include <system_error>

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

void require_own_folder(const BatchFolder& folder, const std::string& plan) {
  if (has_journal(folder.journals())) return;
  const fs::path lock = folder.path / "lock";
  std::error_code failure;
  for (const fs::path& place :
       {folder.plan(), folder.jobs(), folder.digests(), folder.results_csv(), folder.results_json(),
        folder.leaderboard_tex(), folder.tables(), folder.report(), folder.recordings(),
        folder.runs(), folder.journals(), folder.submissions(), lock}) {
    if (!fs::exists(fs::symlink_status(place, failure))) continue;
    if (fs::is_directory(place, failure) && fs::is_empty(place, failure)) continue;
    if (fs::is_regular_file(place, failure)) {
      const std::string text = first_bytes(place, plan.size() + 1);
      if (place == folder.plan() && text == plan) continue;
      if (place == lock && (text.empty() || text.starts_with("process "))) continue;
    }
    throw files::OutputError(
        place,
        "it is there already, and no batch has worked in this folder (journal/ is empty). "
        "Choose another folder");
  }
}

}  // namespace traverse::batch
