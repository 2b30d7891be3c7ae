#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "traverse/pipeline/preset.hpp"
#include "traverse/pipeline/registry.hpp"

#include "commands.hpp"
#include "installed_files.hpp"

namespace traverse::app {

namespace {

void print_presets(const InstalledFiles& installed) {
  for (const pipeline::PresetSummary& preset : pipeline::list_presets(installed.share)) {
    fmt::print("{:<12}{}\n", preset.name, preset.description);
  }
}

void print_settings(const std::string& name, const InstalledFiles& installed) {
  const pipeline::Preset preset = pipeline::load_preset({name, {}, {}}, installed.share);
  fmt::print("{}\n\n", preset.file.string());
  for (const pipeline::ResolvedSetting& resolved : pipeline::resolve_settings(preset)) {
    const config::Setting& setting = resolved.setting;
    const std::string allowed = setting.allowed.empty() ? "" : " (" + setting.allowed + ")";
    fmt::print("{:<34}{:<10}{}{}\n", setting.path, config::to_text(setting.value), setting.meaning,
               allowed);
  }
}

}  // namespace

void add_pipelines(CLI::App& app) {
  auto name = std::make_shared<std::string>();
  CLI::App* pipelines =
      app.add_subcommand("pipelines", "list the presets, or the settings of one of them");
  pipelines->add_option("PRESET", *name, "preset whose settings are listed");
  pipelines->footer(
      "Examples:\n"
      "  traverse pipelines\n"
      "  traverse pipelines traverse      every key that --set takes, its value and its meaning");
  pipelines->callback([name] {
    const InstalledFiles installed = find_installed_files();
    if (name->empty()) {
      print_presets(installed);
    } else {
      print_settings(*name, installed);
    }
  });
}

}  // namespace traverse::app
