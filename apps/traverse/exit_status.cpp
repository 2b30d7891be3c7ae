#include "exit_status.hpp"

#include <cstdio>
#include <exception>

#include <CLI/CLI.hpp>

namespace traverse::app {

namespace {

constexpr int kFailure = 1;
constexpr int kUsage = 2;

}  // namespace

int exit_status(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int status = app.exit(error);
    return status == 0 ? 0 : kUsage;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "traverse: %s\n", error.what());
    return kFailure;
  }
  return 0;
}

}  // namespace traverse::app
