#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "traverse/page/data.hpp"

namespace traverse::page {

/// A section of a page: its line in the contents, its anchor, and the template KIND/ID.html, which
/// is its text.
struct Section {
  std::string id;
  std::string title;
};

/// Data that stands in the page for its scripts.
struct Embedded {
  std::string id;
  std::string type;  ///< "application/octet-stream"
  std::string text;  ///< as it may stand in a script element
};

/// A page in one file that asks the network for nothing.
struct HtmlPage {
  std::string kind;   ///< "run": folder of its sections' templates
  std::string title;  ///< of the document
  std::string program_version;
  std::vector<Section> sections;  ///< in the order of the page
  std::string report_json;        ///< its numbers as JSON, which scripts know as traverse.report
  std::vector<Embedded> embedded{};
  /// Scripts of the templates and libraries (three, orbit_controls, dygraphs), in the order in
  /// which they run, after page.js.
  std::vector<std::string> scripts;
  std::vector<std::string> styles{};  ///< of the templates, over page.css
};

/// The page as text. `parts` fill its sections; they get those of the frame too.
/// \param templates folder with page.html, page.css, table.html, ...
/// \throws files::InputError if a template is missing or is not a valid one.
std::string render(const HtmlPage& page, Data parts, const std::filesystem::path& templates);

/// JSON that may stand in a script element: "<", ">" and "&", which only its texts can hold, as \u
/// escapes.
std::string text_for_script(std::string_view json);

}  // namespace traverse::page
