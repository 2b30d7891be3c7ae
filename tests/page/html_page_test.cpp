#include "traverse/page/html_page.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/page/table.hpp"

#include "temporary_folder.hpp"
#include "web_libraries.hpp"

namespace traverse::page {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using testing::TemporaryFolder;

/// A folder of templates as the project's own is, with one kind of page.
class Templates {
 public:
  Templates() {
    for (const char* name : {"figure.html", "licences.html", "page.css", "page.js"}) add(name, "");
    add("table.html", "{{table_title}}");
    add("page.html",
        "{{page_title}};{{#sections}}[{{id}} {{title}}: {{> section}}]{{/sections}}"
        "{{#embedded}}<{{id}} {{type}}>{{{text}}}{{/embedded}}{{{report_json}}}"
        "{{#scripts}}({{{code}}}){{/scripts}}{{#libraries}}{{name}} {{version}};{{/libraries}}");
    std::filesystem::create_directories(folder_ / "made/licences");
    std::filesystem::create_directories(folder_ / "licences");
    add("licences/dygraphs.txt", "notice");
    add("made/first.html", "{{word}}");
    add("made/second.html", "{{#table_t}}{{> table}}{{/table_t}}");
    add("own.js", "own");
  }
  void add(const std::string& name, const std::string& text) {
    files::write_text(folder_ / name, text);
  }
  std::filesystem::path folder() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

HtmlPage made_page() {
  HtmlPage page;
  page.kind = "made";
  page.title = "A & B";
  page.program_version = "1";
  page.sections = {{"first", "First"}, {"second", "Second"}};
  page.report_json = "{}";
  page.scripts = {"own"};
  return page;
}

TEST(HtmlPage, SectionsFollowEachOtherWithTheirTitlesAndParts) {
  const Templates templates;
  Data parts;
  parts.set("word", "<w>");
  parts.set("table_t", Table("t", "Its title", {"a"}).data());
  HtmlPage page = made_page();
  page.embedded = {{"points", "a/b", "&"}};
  EXPECT_EQ(render(page, parts, templates.folder()),
            "A &amp; B;[first First: &lt;w&gt;][second Second: Its title]<points a/b>&{}()(own)");
}

TEST(HtmlPage, ALibraryBringsItsNotice) {
  const Templates templates;
  HtmlPage page = made_page();
  EXPECT_THAT(render(page, {}, templates.folder()), Not(HasSubstr("dygraphs")));
  page.scripts = {"dygraphs", "own"};
  EXPECT_THAT(render(page, {}, templates.folder()),
              HasSubstr("dygraphs " + std::string(web::kDygraphsVersion) + ";"));
}

TEST(HtmlPage, ABrokenTemplateIsNamed) {
  Templates templates;
  templates.add("made/first.html", "{{#open}}");
  try {
    render(made_page(), {}, templates.folder());
    FAIL() << "a section is not closed";
  } catch (const files::InputError& error) {
    EXPECT_EQ(error.file(), templates.folder() / "page.html");
    EXPECT_THAT(error.expected(), HasSubstr("made"));
  }
  HtmlPage page = made_page();
  page.sections.push_back({"third", "Third"});
  EXPECT_THROW(render(page, {}, templates.folder()), files::InputError) << "no such template";
}

TEST(TextForScript, LeavesNothingThatCouldBeMarkup) {
  EXPECT_EQ(text_for_script(R"({"a": "</script><!-- & -->"})"),
            R"({"a": "\u003c/script\u003e\u003c!-- \u0026 --\u003e"})");
}

TEST(Data, IsAValue) {
  Data inner;
  inner.set("text", "one");
  Data outer;
  outer.set("inner", inner);
  inner.set("text", "two");
  Data copy = outer;
  copy.set("more", true);
  EXPECT_EQ(outer.fill("{{#inner}}{{text}}{{/inner}}{{#more}}!{{/more}}"), "one");
  EXPECT_EQ(copy.fill("{{#inner}}{{text}}{{/inner}}{{#more}}!{{/more}}"), "one!");
  EXPECT_THROW(static_cast<void>(outer.fill("{{#a}}")), std::invalid_argument);
}

}  // namespace
}  // namespace traverse::page
