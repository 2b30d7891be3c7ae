#include "installed_files.hpp"

#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

namespace traverse::app {

namespace {

namespace fs = std::filesystem;

bool complete(const InstalledFiles& files) {
  return fs::is_directory(files.share / "pipelines") && fs::is_directory(files.templates);
}

}  // namespace

InstalledFiles find_installed_files() {
  std::vector<InstalledFiles> places;
  if (const char* folder = std::getenv("TRAVERSE_SHARE")) {
    places.push_back({folder, fs::path(folder) / "templates"});
  }
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  const fs::path installed = program.parent_path().parent_path() / "share/traverse";
  places.push_back({installed, installed / "templates"});

  std::string looked_at;
  for (const InstalledFiles& files : places) {
    if (complete(files)) return files;
    looked_at += "\n  " + files.share.string();
  }
  throw std::runtime_error("the program's own files (pipelines, templates) are not in any of" +
                           looked_at + "\nset TRAVERSE_SHARE to their folder");
}

}  // namespace traverse::app
