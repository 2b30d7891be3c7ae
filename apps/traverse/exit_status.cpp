#include "exit_status.hpp"

#include <string>

#include <CLI/CLI.hpp>

#include "error_text.hpp"
#include "interruption.hpp"
#include "standard_streams.hpp"

namespace traverse::app {

namespace {

constexpr int kFailure = 1;
constexpr int kUsage = 2;

std::string name_of_command(const CLI::App& app) {
  std::string name = app.get_name();
  for (const CLI::App* command : app.get_subcommands()) name += " " + name_of_command(*command);
  return name;
}

int status_of_command(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::RuntimeError& ended) {  // of a command that ended in order, but not as asked
    return ended.get_exit_code();
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kUsage;
  }
  return 0;
}

}  // namespace

int exit_status(CLI::App& app, int argc, char** argv) {
  int status = kFailure;
  try {
    try {
      status = status_of_command(app, argc, argv);
    } catch (...) {
      wait_if_ending();
      require_printed();  // where stdout is what failed, that is told
      throw;
    }
    wait_if_ending();
    require_printed();
  } catch (...) {
    print_message("traverse: {}\n", error_text(name_of_command(app)));
    return kFailure;
  }
  return status;
}

}  // namespace traverse::app
