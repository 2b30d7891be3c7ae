#pragma once

namespace CLI {
class App;
}

namespace traverse::app {

/// Parses the command line and runs the subcommand in it. Errors become a message on stderr.
/// \returns the exit status: 0 done, 1 failed (stdout not taken, too), 2 wrong usage, 128 + a
/// signal when the command ended in order because of it
int exit_status(CLI::App& app, int argc, char** argv);

}  // namespace traverse::app
