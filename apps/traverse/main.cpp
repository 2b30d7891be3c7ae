#include <CLI/CLI.hpp>

#include "bash_completion.hpp"
#include "commands.hpp"
#include "decimal_integers.hpp"
#include "exit_status.hpp"
#include "interruption.hpp"
#include "standard_streams.hpp"

namespace {

constexpr const char* kMainExamples = R"(Examples:
  traverse info DRIVE                              what is in a recording
  traverse doctor DRIVE                            what is wrong with it, and what to do next
  traverse run DRIVE -o RUN                        trajectory, map, pictures and RUN/report.html
  traverse evaluate RUN/trajectory.tum --reference RUN/reference.tum --rpe 10f
  traverse compare RUN OTHER_RUN                   what is better, and whether that is sure
  traverse convert DRIVE drive.rawlog              for MRPT's own tools

`traverse COMMAND --help` explains a command. Exit status: 0 done, 1 failed, 2 wrong usage, 130 ended by
Ctrl-C, 143 by SIGTERM.)";

}  // namespace

int main(int argc, char** argv) {
  traverse::app::prepare_standard_streams();
  traverse::app::end_on_signals();
  CLI::App app{"Traverse: lidar SLAM on recordings, with an accuracy report", "traverse"};
  app.set_version_flag("--version", TRAVERSE_VERSION);
  app.require_subcommand(1);
  app.footer(kMainExamples);
  traverse::app::add_run(app);
  traverse::app::add_localize(app);
  traverse::app::add_import(app);
  traverse::app::add_batch(app);
  traverse::app::add_evaluate(app);
  traverse::app::add_report(app);
  traverse::app::add_compare(app);
  traverse::app::add_info(app);
  traverse::app::add_doctor(app);
  traverse::app::add_convert(app);
  traverse::app::add_map(app);
  traverse::app::add_export(app);
  traverse::app::add_simulate(app);
  traverse::app::add_pipelines(app);
  traverse::app::add_check_jacobians(app);
  traverse::app::add_bench_factors(app);
  traverse::app::add_bash_completion(app);
  traverse::app::read_integers_as_decimal(app);
  return traverse::app::exit_status(app, argc, argv);
}
