#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "traverse/pipeline/run_folder.hpp"

#include "budget_option.hpp"
#include "commands.hpp"
#include "installed_files.hpp"
#include "report_progress.hpp"

namespace traverse::app {

namespace {

constexpr const char* kReportExamples = R"(Examples:
  traverse report RUN                                    report.html, report.json, images/
  traverse report RUN --no-pictures                      the interactive page alone, faster
  traverse report RUN --print-width 8192                 maps for a poster: images/*_print.png
  traverse report RUN --budget share/budgets/kitti.yaml  also says whether limits are kept
  traverse report RUN --export tables                    every table as CSV and LaTeX)";

struct ReportArguments {
  std::string folder;
  report::RunReportOptions options;
};

}  // namespace

void add_report(CLI::App& app) {
  auto arguments = std::make_shared<ReportArguments>();
  CLI::App* report = app.add_subcommand(
      "report", "write report.html and report.json of a run again, with pictures");
  report->add_option("RUN", arguments->folder, "run folder")
      ->required()
      ->check(CLI::ExistingDirectory);
  report->add_flag("!--no-pictures", arguments->options.pictures,
                   "no images: the page has its interactive views alone");
  report
      ->add_option("--picture-width", arguments->options.picture_width,
                   "pixels of a picture; the page grows with it")
      ->check(CLI::Range(480, 8192))
      ->capture_default_str();
  report
      ->add_option("--print-width", arguments->options.print_width,
                   "also draw maps and scans so wide, for paper: images/NAME_print.png")
      ->check(CLI::Range(1600, 8192));
  report
      ->add_option("--export", arguments->options.exports,
                   "folder for every table of the report as CSV and LaTeX")
      ->type_name("DIR");
  add_budget_option(*report, arguments->options.budget);
  report->add_flag("--private", arguments->options.is_private,
                   "the page does not tell whose machine made the run, nor paths on it");
  report->footer(kReportExamples);
  report->callback([arguments] {
    const auto budget = write_report_with_progress(
        arguments->folder, find_installed_files().templates, arguments->options);
    fmt::print("{}\n", pipeline::RunFolder{arguments->folder}.report().string());
    if (budget) require_kept(*budget);
  });
}

}  // namespace traverse::app
