#include "traverse/page/html_page.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"

#include "web_libraries.hpp"

namespace traverse::page {

namespace {

namespace fs = std::filesystem;

constexpr const char* kFrame = "page.html";

Data sections_of(const HtmlPage& page, const fs::path& templates) {
  Data list = Data::list();
  for (const Section& section : page.sections) {
    Data entry;
    entry.set("id", section.id);
    entry.set("title", section.title);
    entry.set("section", files::read_text(templates / page.kind / (section.id + ".html")));
    list.push_back(std::move(entry));
  }
  return list;
}

Data embedded_in(const HtmlPage& page) {
  Data list = Data::list();
  for (const Embedded& embedded : page.embedded) {
    Data entry;
    entry.set("id", embedded.id);
    entry.set("type", embedded.type);
    entry.set("text", embedded.text);
    list.push_back(std::move(entry));
  }
  return list;
}

bool uses(const HtmlPage& page, const std::string& script) {
  return std::find(page.scripts.begin(), page.scripts.end(), script) != page.scripts.end();
}

std::string style_of(const HtmlPage& page, const fs::path& templates) {
  std::string style;
  if (uses(page, "dygraphs")) style += std::string(web::dygraphs_style()) + "\n";
  style += files::read_text(templates / "page.css");
  for (const std::string& name : page.styles)
    style += files::read_text(templates / (name + ".css"));
  return style;
}

std::string code_of(const std::string& script, const fs::path& templates) {
  if (script == "three") return std::string(web::three());
  if (script == "orbit_controls") return std::string(web::orbit_controls());
  if (script == "dygraphs") return std::string(web::dygraphs());
  return files::read_text(templates / (script + ".js"));
}

Data scripts_of(const HtmlPage& page, const fs::path& templates) {
  Data list = Data::list();
  const auto add = [&](const std::string& script) {
    Data entry;
    entry.set("code", code_of(script, templates));
    list.push_back(std::move(entry));
  };
  add("page");
  for (const std::string& script : page.scripts) add(script);
  return list;
}

/// The notices that the licences of the page's libraries want in every copy of them.
Data licences_of(const HtmlPage& page, const fs::path& templates) {
  Data list = Data::list();
  const auto add = [&](const char* script, const char* name, const std::string& version) {
    if (!uses(page, script)) return;
    Data entry;
    entry.set("name", name);
    entry.set("version", version);
    entry.set("notice", files::read_text(templates / "licences" / (std::string(script) + ".txt")));
    list.push_back(std::move(entry));
  };
  add("three", "three.js", "r" + std::string(web::kThreeVersion));
  add("dygraphs", "dygraphs", std::string(web::kDygraphsVersion));
  return list;
}

}  // namespace

std::string render(const HtmlPage& page, Data parts, const fs::path& templates) {
  for (const std::string name : {"figure", "licences", "table"}) {
    parts.set(name, files::read_text(templates / (name + ".html")));
  }
  parts.set("page_title", page.title);
  parts.set("program_version", page.program_version);
  parts.set("style", style_of(page, templates));
  parts.set("sections", sections_of(page, templates));
  parts.set("report_json", page.report_json);
  parts.set("embedded", embedded_in(page));
  parts.set("scripts", scripts_of(page, templates));
  parts.set("libraries", licences_of(page, templates));
  try {
    return parts.fill(files::read_text(templates / kFrame));
  } catch (const std::invalid_argument& error) {
    throw files::InputError(templates / kFrame, files::Place::whole_file(),
                            "a valid template, with valid ones of " + page.kind, error.what());
  }
}

std::string text_for_script(std::string_view json) {
  std::string text;
  text.reserve(json.size() + json.size() / 64);
  for (const char c : json) {
    switch (c) {
      case '<':
        text += "\\u003c";
        break;
      case '>':
        text += "\\u003e";
        break;
      case '&':
        text += "\\u0026";
        break;
      default:
        text += c;
    }
  }
  return text;
}

}  // namespace traverse::page
