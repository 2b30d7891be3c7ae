#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "traverse/replay/player.hpp"

namespace CLI {
class App;
}

namespace traverse::app {

/// What the command line asks for.
struct OpenRequest {
  std::string file_or_run;
  std::string moved_to;
  std::string recording_config;
  std::vector<std::string> statements;
  pipeline::PresetRequest preset;
  int threads = 1;
  std::string at;  ///< a place to begin; empty: the first frame
  bool play = false;
  bool headless = false;
  std::string script;
  std::string output_folder = ".";
  int width = 1400;
  int height = 910;
  bool keep_index = true;
};

void add_options(CLI::App& app, OpenRequest& request);

/// \throws files::InputError
replay::Recording open(const OpenRequest& request);

}  // namespace traverse::app
