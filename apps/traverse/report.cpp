#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "traverse/pipeline/run_folder.hpp"

#include "commands.hpp"
#include "installed_files.hpp"
#include "report_progress.hpp"

namespace traverse::app {

void add_report(CLI::App& app) {
  auto folder = std::make_shared<std::string>();
  CLI::App* report = app.add_subcommand("report", "draw the pictures and write report.html again");
  report->add_option("RUN", *folder, "run folder")->required()->check(CLI::ExistingDirectory);
  report->footer("Example:\n  traverse report RUN");
  report->callback([folder] {
    write_report_with_progress(*folder, find_installed_files().templates);
    fmt::print("{}\n", pipeline::RunFolder{*folder}.report().string());
  });
}

}  // namespace traverse::app
