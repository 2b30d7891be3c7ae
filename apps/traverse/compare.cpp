#include "traverse/report/compare.hpp"

#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "traverse/batch/compare_runs.hpp"

#include "command_line.hpp"
#include "commands.hpp"
#include "installed_files.hpp"

namespace traverse::app {

namespace {

constexpr const char* kCompareExamples = R"(Examples:
  traverse compare runs/before runs/after
  traverse compare drive1/* drive2/* -o all.html
  traverse compare runs/floam runs/other runs/third -o floam-and-others.html --threshold 5

The first run is the baseline. A figure has improved or regressed when the 95 % interval of its
difference, from the paired moving-block bootstrap, lies beyond the threshold as a whole. Runs of
more than one recording are put on the page of a batch: ranking, heat table, accuracy against time,
box plots, how they were compared; a LaTeX table stands beside it.)";

struct CompareArguments {
  std::vector<std::filesystem::path> runs;
  std::filesystem::path page = "compare.html";
  report::CompareOptions options;
  bool many = false;  ///< the page for many also of runs of one recording
};

}  // namespace

void add_compare(CLI::App& app) {
  auto arguments = std::make_shared<CompareArguments>();
  CLI::App* compare = app.add_subcommand(
      "compare", "put runs side by side, of one recording or of several: HTML, JSON, table");
  compare->add_option("RUN", arguments->runs, "run folders, the baseline first")
      ->required()
      ->expected(2, 10000)
      ->check(CLI::ExistingDirectory);
  compare->add_option("-o,--output", arguments->page, "page to write; its JSON stands beside it")
      ->type_name("FILE.html")
      ->capture_default_str();
  compare
      ->add_option("--threshold", arguments->options.threshold_percent,
                   "percent of the baseline below which a difference does not count")
      ->check(CLI::Range(0.0, 1000.0))
      ->capture_default_str();
  compare->add_flag("--many", arguments->many,
                    "the page that runs of several recordings get, also for those of one");
  compare->add_flag("--private", arguments->options.is_private,
                    "the page does not tell whose machine made the runs, nor paths on it");
  compare->footer(kCompareExamples);
  compare->callback([arguments] {
    if (arguments->page.extension() != ".html") {
      throw CLI::ValidationError("--output", "must end in .html");
    }
    if (arguments->many || batch::count_recordings(arguments->runs) > 1) {
      fmt::print("{}{}\n",
                 batch::write_runs_comparison(arguments->runs, arguments->page,
                                              {arguments->options.is_private, command_line(),
                                               find_installed_files().templates}),
                 arguments->page.string());
      return;
    }
    fmt::print("{}{}\n",
               report::write_comparison(arguments->runs, arguments->page,
                                        find_installed_files().templates, arguments->options),
               arguments->page.string());
  });
}

}  // namespace traverse::app
