// Reads one file with one of the project's readers and tells what came of it and the most memory
// that took: a process of its own, so that nothing else is measured, and a small one, so that
// little else is. Exit status: 0 read, 1 refused with an InputError, 3 any other exception.

#include <fstream>
#include <functional>
#include <map>
#include <string>

#include <fmt/format.h>

#include "traverse/config/document.hpp"
#include "traverse/dataset/open_recording.hpp"
#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/mrpt_io/simple_map_file.hpp"

namespace {

using namespace traverse;

std::string read_recording(const std::string& path) {
  const auto source = dataset::open_recording(path, {{}, {}, TRAVERSE_SHARE_DIR});
  std::size_t count = 0;
  while (source->next()) ++count;
  std::string text = fmt::format("{} measurements", count);
  for (const auto& [reason, skipped] : source->skipped().by_reason()) {
    text += fmt::format("; {} x {}", skipped.count, reason);
  }
  return text;
}

const std::map<std::string, std::function<std::string(const std::string&)>> kReaders{
    {"nothing", [](const std::string&) { return std::string("nothing read"); }},
    {"cloud",
     [](const std::string& path) {
       return fmt::format("{} points", dataset::read_point_cloud(path).size());
     }},
    {"recording", read_recording},
    {"trajectory",
     [](const std::string& path) {
       return fmt::format("{} poses",
                          dataset::read_trajectory(path, dataset::TrajectoryFormat::kAuto).size());
     }},
    {"yaml",
     [](const std::string& path) {
       return fmt::format("{} values", config::Document::load(path).leaves().size());
     }},
    {"settings",
     [](const std::string& path) {
       double known = 0;
       config::read(config::Document::load(path),
                    [&](config::Binder& b) { b.number("known", known, config::Range::any(), ""); });
       return std::string("settings");
     }},
    {"map", [](const std::string& path) {
       return fmt::format("{} keyframes", mrpt_io::for_each_keyframe(
                                              path, [](std::size_t, const auto&, const auto&) {}));
     }}};

/// Of this process, kilobytes; ru_maxrss would count the process that started this one.
std::string peak_kb() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word == "VmHWM:" && status >> word) return word;
  }
  return "0";
}

}  // namespace

int main(int, char** arguments) {
  int exit_status = 0;
  std::string outcome;
  try {
    outcome = kReaders.at(arguments[1])(arguments[2]);
  } catch (const files::InputError& error) {
    outcome = error.what();
    exit_status = 1;
  } catch (const std::exception& error) {
    outcome = error.what();
    exit_status = 3;
  }
  fmt::print("{}\n{}\n", peak_kb(), outcome);
  return exit_status;
}
