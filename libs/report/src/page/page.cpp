#include "page/page.hpp"

#include <string_view>

#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"

#include "page/web_libraries.hpp"

namespace traverse::report {

namespace {

void add_figures(const std::vector<Figure>& figures, Model& model) {
  Json json = Json::array();
  for (const Figure& figure : figures) {
    json.push_back({{"name", figure.name},
                    {"section", figure.section},
                    {"caption", figure.caption},
                    {"files", {figure.name + ".png", figure.name + "_dark.png"}}});
  }
  model.json["pictures"] = std::move(json);
  for (const std::string section : kFigureSections) {
    TemplateData list{TemplateData::type::list};
    for (const Figure& figure : figures) {
      if (figure.section != section) continue;
      TemplateData entry;
      entry.set("name", figure.name);
      entry.set("caption", figure.caption);
      entry.set("replaced_by", figure.replaced_by);
      entry.set("light", figure.light);
      entry.set("dark", figure.dark);
      list.push_back(entry);
    }
    model.page.set("figures_" + section, list);
  }
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
  for (const std::string name : {"figure", "licences", "table", "factors"}) {
    const std::string text = files::read_text(templates / (name + ".html"));
    page.set(name, kainjow::mustache::partial([text] { return text; }));
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

std::string make_page(Model& model, const std::string& packed_points,
                      const std::vector<Figure>& figures, const std::filesystem::path& templates) {
  add_figures(figures, model);
  model.page.set("report_json", text_for_script(model.json));
  model.page.set("points", packed_points);
  return render_page(model.page, "run",
                     {"three", "orbit_controls", "dygraphs", "moment", "charts", "scene_colours",
                      "scene_points", "scene_way", "scene_measure", "scene", "csv", "tables"},
                     templates);
}

}  // namespace traverse::report
