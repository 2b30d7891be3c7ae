#pragma once

namespace CLI {
class App;
}

/// One function a subcommand, each in its own file: it declares the arguments and sets the callback
/// that does the work. Errors are thrown and reported by main(); no algorithm stands here.
namespace traverse::app {

void add_batch(CLI::App& app);
void add_bench_factors(CLI::App& app);
void add_check_jacobians(CLI::App& app);
void add_compare(CLI::App& app);
void add_convert(CLI::App& app);
void add_doctor(CLI::App& app);
void add_evaluate(CLI::App& app);
void add_export(CLI::App& app);
void add_import(CLI::App& app);
void add_info(CLI::App& app);
void add_localize(CLI::App& app);
void add_map(CLI::App& app);
void add_pipelines(CLI::App& app);
void add_report(CLI::App& app);
void add_run(CLI::App& app);
void add_simulate(CLI::App& app);
/// `simulate` that only checks its arguments: world, sensor and settings are there and right.
void add_simulate_check(CLI::App& app);

}  // namespace traverse::app
