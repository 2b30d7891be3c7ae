#include "page.hpp"

#include <kainjow/mustache.hpp>

#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"

#include "data_uri.hpp"
#include "sections.hpp"

namespace traverse::report {

namespace {

void add_figures(const std::vector<Figure>& figures, TemplateData& page) {
  for (const std::string section : {"trajectory", "error", "map", "health", "timing"}) {
    TemplateData list{TemplateData::type::list};
    for (const Figure& figure : figures) {
      if (figure.section != section) continue;
      TemplateData entry;
      entry.set("name", figure.name);
      entry.set("caption", figure.caption);
      entry.set("light", png_data_uri(figure.light_png));
      entry.set("dark", png_data_uri(figure.dark_png));
      list.push_back(entry);
    }
    page.set("figures_" + section, list);
  }
}

}  // namespace

std::string make_page(const RunData& run, const std::vector<Figure>& figures,
                      const std::filesystem::path& templates) {
  TemplateData page;
  page.set("recording", run.recording_name());
  page.set("pipeline", run.pipeline_name());
  page.set("date", run.date());
  page.set("style", files::read_text(templates / "run.css"));
  page.set("script", files::read_text(templates / "run.js"));
  for (const std::string name : {"figure", "table", "factors"}) {
    const std::string text = files::read_text(templates / (name + ".html"));
    page.set(name, kainjow::mustache::partial([text] { return text; }));
  }
  add_verdict(run, page);
  add_accuracy(run, page);
  add_health(run, page);
  add_timing(run, page);
  add_factors(run, page);
  add_navigation(run, page);
  add_provenance(run, page);
  add_figures(figures, page);

  const std::filesystem::path file = templates / "run.html";
  kainjow::mustache::mustache page_template(files::read_text(file));
  if (!page_template.is_valid()) {
    throw files::InputError(file, files::Place::whole_file(), "a valid template",
                            page_template.error_message());
  }
  return page_template.render(page);
}

}  // namespace traverse::report
