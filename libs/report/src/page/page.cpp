#include "page/page.hpp"

#include <map>
#include <utility>

#include "traverse/page/html_page.hpp"

#include "sections/report_sections.hpp"

namespace traverse::report {

namespace {

void add_figures(const std::vector<Figure>& figures, Model& model) {
  Json json = Json::array();
  std::map<std::string, page::Data> by_section;
  for (const Figure& figure : figures) {
    json.push_back({{"name", figure.name},
                    {"section", figure.section},
                    {"caption", figure.caption},
                    {"files", {figure.name + ".png", figure.name + "_dark.png"}}});
    page::Data entry;
    entry.set("name", figure.name);
    entry.set("caption", figure.caption);
    entry.set("replaced_by", figure.replaced_by);
    entry.set("light", figure.light);
    entry.set("dark", figure.dark);
    by_section.try_emplace(figure.section, page::Data::list()).first->second.push_back(entry);
  }
  model.json["pictures"] = std::move(json);
  for (auto& [section, list] : by_section) model.page.set("figures_" + section, std::move(list));
}

}  // namespace

std::string make_page(ReportModel& report, const std::vector<Figure>& figures,
                      const std::filesystem::path& templates) {
  Model& model = report.model;
  add_figures(figures, model);
  page::HtmlPage shown;
  shown.kind = "run";
  shown.title = model.text("recording") + " · " + model.text("pipeline");
  shown.program_version = model.text("program_version");
  for (const ReportSection* section : report.sections) {
    shown.sections.push_back({std::string(section->id), std::string(section->title)});
  }
  shown.report_json = script_text(model.json);
  shown.embedded = {{"map-points", "application/octet-stream", report.packed_points}};
  shown.scripts = {"three",     "orbit_controls", "dygraphs",      "moment",
                   "plot",      "charts",         "scene_colours", "scene_points",
                   "scene_way", "scene_measure",  "scene",         "tables"};
  return page::render(shown, model.page, templates);
}

}  // namespace traverse::report
