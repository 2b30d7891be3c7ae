#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace traverse::replay {

/// One line of a script.
struct ScriptCommand {
  std::size_t line = 0;  ///< of the file, from 1
  std::string name;
  std::string argument;  ///< all that follows; empty if nothing does
};

/// What a script may say, with its argument and what it does; --help-script prints it.
struct ScriptWord {
  std::string_view name;
  std::string_view argument;  ///< empty: takes none
  std::string_view meaning;
};
inline constexpr std::array<ScriptWord, 22> kScriptWords{{
    {"play", "", "starts playing"},
    {"pause", "", "stops playing"},
    {"step", "N", "goes on N frames, or back with -N; pauses"},
    {"seek", "PLACE", "a frame (120), a time from the start (12.5s, 1:02), or a stamp in seconds"},
    {"home", "", "goes to the first frame"},
    {"end", "", "goes to the last frame"},
    {"speed", "X", "0.1 to 16 times real time, or max"},
    {"loop", "on|off", "begins again at the end"},
    {"range", "A B|off", "plays frames A to B only"},
    {"colour", "NAME", "of the scan: class, ring, time, height, intensity, residual"},
    {"view", "NAME", "follow, top or free"},
    {"show", "LAYER on|off", "scan, map, local-map, matches, estimate, reference, grid, help"},
    {"pipeline", "NAME", "chooses the preset that restart begins"},
    {"set", "KEY=VALUE", "one setting of the pipeline that restart begins"},
    {"restart", "here|start", "begins the estimator again at this frame or the first"},
    {"save", "FOLDER", "writes trajectory and map up to the frame on show"},
    {"screenshot", "FILE.png", "writes what the window shows"},
    {"wait", "SECONDS", "lets the window run"},
    {"wait-frame", "N", "until frame N or a later one is on show"},
    {"settle", "", "until the frame asked for is on show and no job waits"},
    {"expect-frame", "N", "fails unless frame N is on show"},
    {"quit", "", "closes the window"},
}};

/// Reads a script: a command a line, '#' begins a comment.
/// \throws files::InputError naming the line of a command that is not known or lacks its argument.
std::vector<ScriptCommand> read_script(const std::filesystem::path& file);

}  // namespace traverse::replay
