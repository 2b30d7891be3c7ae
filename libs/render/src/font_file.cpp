#include <cstdlib>
#include <string>

#include "traverse/files/input_error.hpp"

#include "text_measure.hpp"

namespace traverse::render {

std::vector<std::filesystem::path> font_folders() {
  std::vector<std::filesystem::path> folders;
  if (const char* chosen = std::getenv("TRAVERSE_FONTS")) folders.emplace_back(chosen);
  for (const char* folder : {"/usr/share/fonts/truetype/dejavu",    // Debian: fonts-dejavu-core
                             "/usr/share/fonts/dejavu-sans-fonts",  // Fedora
                             "/usr/share/fonts/TTF",                // Arch
                             "/usr/local/share/fonts"}) {
    folders.emplace_back(folder);
  }
  return folders;
}

std::filesystem::path font_file(FontWeight weight,
                                const std::vector<std::filesystem::path>& folders) {
  const char* name = weight == FontWeight::kBold ? "DejaVuSans-Bold.ttf" : "DejaVuSans.ttf";
  std::string looked_at;
  for (const auto& folder : folders) {
    if (std::filesystem::is_regular_file(folder / name)) return folder / name;
    looked_at += (looked_at.empty() ? "" : ", ") + folder.string();
  }
  throw files::InputError(name, files::Place::whole_file(),
                          "the font DejaVu Sans (Debian package fonts-dejavu-core; or set "
                          "TRAVERSE_FONTS to its folder) in one of " +
                              looked_at,
                          "none");
}

}  // namespace traverse::render
