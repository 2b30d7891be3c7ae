#include "exit_status.hpp"

#include <cstdio>
#include <exception>
#include <new>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

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

/// Where nothing but the sentence is left to be done, and little may be allocated.
constexpr const char* kNoMemory =
    "out of memory: the system gave no more while the command was at work. Close other programs, "
    "or give it less at a time (--first and --last, fewer --threads, a coarser --set ...)";

/// Tells what is being thrown.
void tell_error(const CLI::App& app) {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    print_message("traverse: {}\n", kNoMemory);
  } catch (const std::length_error& error) {
    print_message("traverse: {}\n", kNoMemory);
  } catch (const nlohmann::json::exception& error) {
    print_message(
        "traverse: {}: a JSON file that was read is not as this program writes it ({}). Make it "
        "anew with the command that wrote it\n",
        name_of_command(app), error.what());
  } catch (const std::exception& error) {
    print_message("traverse: {}\n", error.what());
  }
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
    tell_error(app);
    return kFailure;
  }
  return status;
}

}  // namespace traverse::app
