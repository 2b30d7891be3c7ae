#include <cstdio>
#include <exception>
#include <nanogui/opengl.h>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "traverse/replay/script.hpp"

#include "bash_completion.hpp"
#include "console.hpp"
#include "decimal_integers.hpp"
#include "error_text.hpp"
#include "interruption.hpp"
#include "message_window.hpp"
#include "open_request.hpp"
#include "replay_window.hpp"
#include "script_runner.hpp"
#include "standard_streams.hpp"

namespace traverse::app {

namespace {

constexpr int kFailure = 1;
constexpr int kUsage = 2;

constexpr const char* kExamples = R"(Examples:
  traverse-replay drive.rawlog                       with the preset traverse at work
  traverse-replay drive.rawlog --pipeline floam --set map.radius_m=60 --play
  traverse-replay RUN --at 1317042145.964            a run of `traverse run`, at a stamp
  xvfb-run traverse-replay drive.rawlog --headless --script pictures.txt
H in the window shows the keys. Exit status: 0 done, 1 failed, 2 wrong usage.)";

void print_script_help() {
  std::puts("A script is a text file, a command a line; '#' begins a comment.");
  for (const auto& word : replay::kScriptWords) {
    const std::string head = fmt::format("{} {}", word.name, word.argument);
    fmt::print("  {:<24} {}\n", head, word.meaning);
  }
}

void print_report(const RedrawReport& report) {
  if (report.seconds > 0) {
    fmt::print(
        "redraws while playing: {} in {:.1f} s ({:.1f} a second), at most {} points, the "
        "window's loop never took longer than {:.0f} ms\n",
        report.redraws, report.seconds, static_cast<double>(report.redraws) / report.seconds,
        report.max_points, 1000 * report.longest_s);
  }
  if (report.gl_errors > 0) print_message("OpenGL errors: {}\n", report.gl_errors);
}

/// At the first rounds of the window not even the first frame may be known.
bool seek_when_known(const std::string& at, replay::Player& player) {
  const replay::Timeline timeline = player.timeline();
  if (timeline.size() == 0 && !timeline.complete()) return false;
  if (!player.seek(at)) {
    throw std::runtime_error(fmt::format(
        "--at: expected a frame (120), a time (12.5s, 1:02) or a stamp, found '{}'", at));
  }
  return true;
}

int run_window(const OpenRequest& request, replay::Player& player, const std::string& title) {
  std::optional<ScriptRunner> script;
  if (!request.script.empty()) script.emplace(request.script);
  int status = 0;
  nanogui::init();
  {
    Console console(player, request.preset, request.output_folder);
    nanogui::ref<ReplayWindow> window =
        new ReplayWindow(console, title, request.width, request.height);
    window->setVisible(true);
    if (request.play) console.execute("play");
    bool has_sought = request.at.empty();
    try {
      while (window->round()) {
        if (!has_sought) {
          has_sought = seek_when_known(request.at, player);
        } else if (script && !script->work(console, *window)) {
          if (request.headless) break;
          script.reset();
        }
      }
    } catch (const std::exception&) {
      print_message("traverse-replay: {}\n", error_text("traverse-replay"));
      status = kFailure;
    }
    if (request.headless) print_report(window->report());
    if (window->report().gl_errors > 0) status = kFailure;
    const std::string error = player.status().error;
    if (request.headless && !error.empty()) {
      print_message("traverse-replay: {}\n", error);
      status = kFailure;
    }
  }
  nanogui::shutdown();
  return status;
}

/// What must be known of a run before anybody looks at it.
void print_health(const replay::Recording& recording) {
  const pipeline::RunHealth* health = recording.health();
  if (health == nullptr || health->reasons.empty()) return;
  print_message("traverse-replay: this run is {}: {}\n", name_of(health->verdict),
                health->summary());
}

int replay_file(const OpenRequest& request) {
  std::optional<replay::Player> player;
  try {
    replay::PlayerOptions options;
    options.preset = request.preset;
    options.threads = request.threads;
    options.keep_index = request.keep_index;
    player.emplace(open(request), options);
  } catch (const std::exception&) {
    print_message("traverse-replay: {}\n", error_text("traverse-replay"));
    if (!request.headless)
      show_message("Traverse replay: nothing to show", error_text("traverse-replay"));
    return kFailure;
  }
  print_health(player->recording());
  if (glfwInit() == GLFW_FALSE) {
    print_message(
        "traverse-replay: no display to open a window on; under "
        "`xvfb-run traverse-replay ...` there is one\n");
    return kFailure;
  }
  return run_window(request, *player,
                    "Traverse replay: " + player->recording().info().path.filename().string());
}

}  // namespace

}  // namespace traverse::app

int main(int argc, char** argv) {
  using traverse::app::kFailure;
  using traverse::app::kUsage;
  traverse::app::prepare_standard_streams();
  traverse::app::end_on_signals();
  CLI::App app{"Traverse replay: a window on a recording, with the estimator at work in it",
               "traverse-replay"};
  app.set_version_flag("--version", TRAVERSE_VERSION);
  app.footer(traverse::app::kExamples);
  traverse::app::OpenRequest request;
  bool help_script = false;
  traverse::app::add_options(app, request);
  app.add_flag("--help-script", help_script, "list the commands of a script and exit");
  traverse::app::add_bash_completion(app);
  traverse::app::read_integers_as_decimal(app);
  int status = kFailure;
  try {
    try {
      app.parse(argc, argv);
      if (request.file_or_run.empty() && !help_script) throw CLI::RequiredError("FILE|RUN");
      if (request.headless && request.script.empty() && !help_script) {
        throw CLI::ValidationError("--headless", "needs --script");
      }
      if (help_script) {
        traverse::app::print_script_help();
        status = 0;
      } else {
        status = traverse::app::replay_file(request);
      }
    } catch (const CLI::ParseError& error) {
      status = app.exit(error) == 0 ? 0 : kUsage;
    }
    traverse::app::wait_if_ending();
    traverse::app::require_printed();
  } catch (...) {
    traverse::app::wait_if_ending();
    traverse::app::print_message("traverse-replay: {}\n",
                                 traverse::app::error_text("traverse-replay"));
    return kFailure;
  }
  return status;
}
