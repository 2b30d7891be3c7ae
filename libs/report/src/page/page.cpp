#include "page/page.hpp"

#include <map>
#include <string_view>

#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"

#include "page/web_libraries.hpp"
#include "sections/report_sections.hpp"

namespace traverse::report {

namespace {

kainjow::mustache::partial partial_of(const std::filesystem::path& file) {
  return [text = files::read_text(file)] { return text; };
}

void add_figures(const std::vector<Figure>& figures, Model& model) {
  Json json = Json::array();
  for (const Figure& figure : figures) {
    json.push_back({{"name", figure.name},
                    {"section", figure.section},
                    {"caption", figure.caption},
                    {"files", {figure.name + ".png", figure.name + "_dark.png"}}});
  }
  model.json["pictures"] = std::move(json);
  std::map<std::string, TemplateData> by_section;
  for (const Figure& figure : figures) {
    TemplateData entry;
    entry.set("name", figure.name);
    entry.set("caption", figure.caption);
    entry.set("replaced_by", figure.replaced_by);
    entry.set("light", figure.light);
    entry.set("dark", figure.dark);
    by_section.try_emplace(figure.section, TemplateData::type::list).first->second.push_back(entry);
  }
  for (const auto& [section, list] : by_section) model.page.set("figures_" + section, list);
}

/// The sections that apply, each with its template.
TemplateData sections(const std::vector<const ReportSection*>& applying,
                      const std::filesystem::path& templates) {
  TemplateData list{TemplateData::type::list};
  for (const ReportSection* section : applying) {
    const std::string id(section->id);
    TemplateData entry;
    entry.set("id", id);
    entry.set("title", std::string(section->title));
    entry.set("section", partial_of(templates / "sections" / (id + ".html")));
    list.push_back(entry);
  }
  return list;
}

std::string library(const std::string& name) {
  if (name == "three") return std::string(web::three());
  if (name == "orbit_controls") return std::string(web::orbit_controls());
  if (name == "dygraphs") return std::string(web::dygraphs());
  return {};
}

/// The notices that the licences of the libraries among `scripts` want in every copy of them.
TemplateData licences(const std::vector<std::string>& scripts,
                      const std::filesystem::path& templates) {
  TemplateData list{TemplateData::type::list};
  for (const std::string& script : scripts) {
    TemplateData entry;
    if (script == "three") {
      entry.set("name", "three.js");
      entry.set("version", "r" + std::string(web::kThreeVersion));
    } else if (script == "dygraphs") {
      entry.set("name", "dygraphs");
      entry.set("version", std::string(web::kDygraphsVersion));
    } else {
      continue;
    }
    entry.set("notice", files::read_text(templates / "licences" / (script + ".txt")));
    list.push_back(entry);
  }
  return list;
}

}  // namespace

std::string render_page(TemplateData& page, const std::string& page_name,
                        const std::vector<std::string>& scripts,
                        const std::filesystem::path& templates) {
  page.set("style",
           std::string(web::dygraphs_style()) + "\n" + files::read_text(templates / "run.css"));
  for (const std::string name : {"figure", "licences", "table"}) {
    page.set(name, partial_of(templates / (name + ".html")));
  }
  TemplateData list{TemplateData::type::list};
  for (const std::string& name : scripts) {
    TemplateData entry;
    std::string code = library(name);
    entry.set("code", code.empty() ? files::read_text(templates / (name + ".js")) : code);
    list.push_back(entry);
  }
  page.set("scripts", list);
  page.set("libraries", licences(scripts, templates));

  const std::filesystem::path file = templates / (page_name + ".html");
  kainjow::mustache::mustache page_template(files::read_text(file));
  if (!page_template.is_valid()) {
    throw files::InputError(file, files::Place::whole_file(), "a valid template",
                            page_template.error_message());
  }
  return page_template.render(page);
}

std::string make_page(ReportModel& report, const std::vector<Figure>& figures,
                      const std::filesystem::path& templates) {
  TemplateData& page = report.model.page;
  add_figures(figures, report.model);
  page.set("sections", sections(report.sections, templates));
  page.set("report_json", text_for_script(report.model.json));
  page.set("points", report.packed_points);
  return render_page(page, "run",
                     {"three", "orbit_controls", "dygraphs", "moment", "charts", "scene_colours",
                      "scene_points", "scene_way", "scene_measure", "scene", "csv", "tables"},
                     templates);
}

}  // namespace traverse::report
