#include "console.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "traverse/files/numbers.hpp"

namespace traverse::app {

namespace {

/// The place of `name` in `names`, or their number.
template <typename Names>
std::size_t index_of(const Names& names, const std::string& name) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

std::string expected(const std::string& what, const std::string& found) {
  return fmt::format("expected {}, found '{}'", what, found);
}

}  // namespace

Console::Console(replay::Player& player, pipeline::PresetRequest request,
                 std::filesystem::path output_folder)
    : player_(player), request_(std::move(request)), output_folder_(std::move(output_folder)) {}

std::string Console::execute(const std::string& name, const std::string& argument) {
  using Words = std::string (Console::*)(const std::string&, const std::string&, bool&);
  std::string fault = fmt::format("'{}' is not a command", name);
  for (const Words words : {&Console::play_word, &Console::view_word, &Console::estimator_word}) {
    bool known = true;
    const std::string found = (this->*words)(name, argument, known);
    if (!known) continue;
    fault = found;
    break;
  }
  if (!fault.empty()) message_ = name + ": " + fault;
  return fault;
}

std::string Console::play_word(const std::string& name, const std::string& argument, bool& known) {
  using replay::Controls;
  const auto control = [&](auto&& change) {
    player_.control(change);
    return std::string();
  };
  if (name == "play") return control([](Controls& c) { c.play(); });
  if (name == "pause") return control([](Controls& c) { c.pause(); });
  if (name == "toggle") return control([](Controls& c) { c.toggle(); });
  if (name == "home") return control([](Controls& c) { c.home(); });
  if (name == "end") return control([](Controls& c) { c.end(); });
  if (name == "faster") return control([](Controls& c) { c.faster(); });
  if (name == "slower") return control([](Controls& c) { c.slower(); });
  if (name == "step") {
    const auto frames = files::parse_integer(argument);
    if (!frames) return expected("a number of frames", argument);
    return control([&](Controls& c) { c.step(static_cast<std::ptrdiff_t>(*frames)); });
  }
  if (name == "seek") {
    return player_.seek(argument)
               ? ""
               : expected("a frame (120), a time (12.5s, 1:02) or a stamp", argument);
  }
  if (name == "speed") return set_speed(argument);
  if (name == "loop") {
    return control(
        [&](Controls& c) { c.set_loop(argument == "toggle" ? !c.loop() : argument == "on"); });
  }
  if (name == "range") return set_range(argument);
  known = false;
  return "";
}

std::string Console::set_speed(const std::string& argument) {
  const auto speed = files::parse_double(argument);
  if (!speed && argument != "max") return expected("0.1 to 16, or max", argument);
  player_.control([&](replay::Controls& c) {
    c.set_unlimited(!speed);
    if (speed) c.set_speed(*speed);
  });
  return "";
}

std::string Console::set_range(const std::string& argument) {
  const auto words = files::split_words(argument);
  const auto shown = player_.status().shown;
  if (argument == "off") {
    player_.control([](replay::Controls& c) { c.set_range({}, {}); });
  } else if (argument == "from-here" && shown) {
    player_.control([&](replay::Controls& c) { c.set_range(*shown, c.range_last()); });
  } else if (argument == "to-here" && shown) {
    player_.control([&](replay::Controls& c) { c.set_range(c.range_first(), *shown); });
  } else {
    const auto first = words.size() == 2 ? files::parse_integer(words[0]) : std::nullopt;
    const auto last = words.size() == 2 ? files::parse_integer(words[1]) : std::nullopt;
    if (!first || !last || *first < 0 || *last < 0) return expected("two frames, or off", argument);
    player_.control([&](replay::Controls& c) {
      c.set_range(static_cast<std::size_t>(*first), static_cast<std::size_t>(*last));
    });
  }
  return "";
}

std::string Console::view_word(const std::string& name, const std::string& argument, bool& known) {
  if (name == "colour") {
    const auto colour = replay::scan_colour_named(argument);
    if (!colour) return expected("class, ring, time, height, intensity or residual", argument);
    view_.colour = *colour;
    return "";
  }
  if (name == "view") {
    const std::size_t index = index_of(kCameraNames, argument);
    if (index == kCameraNames.size()) return expected("follow, top or free", argument);
    view_.camera = static_cast<CameraMode>(index);
    return "";
  }
  if (name == "show") return show_layer(argument);
  if (name == "help") {
    view_.help = !view_.help;
    return "";
  }
  if (name == "screenshot") {
    screenshot_ =
        argument.empty() ? output_folder_ / file_name(".png") : std::filesystem::path(argument);
    return "";
  }
  if (name == "quit") {
    quit_ = true;
    return "";
  }
  known = false;
  return "";
}

std::string Console::show_layer(const std::string& argument) {
  const auto words = files::split_words(argument);
  const bool is_switch = words.size() == 2 && (words[1] == "on" || words[1] == "off");
  if (!is_switch) return expected("a layer and on or off", argument);
  if (words[0] == "help") {
    view_.help = words[1] == "on";
    return "";
  }
  const std::size_t index = index_of(kLayerNames, std::string(words[0]));
  if (index == kLayerNames.size()) return expected("a layer", std::string(words[0]));
  view_.layers[index] = words[1] == "on";
  return "";
}

std::string Console::estimator_word(const std::string& name, const std::string& argument,
                                    bool& known) {
  if (name == "pipeline") {
    if (argument != request_.name) request_ = {argument, {}, {}};
    return "";
  }
  if (name == "set") {
    if (argument.find('=') == std::string::npos) return expected("KEY=VALUE", argument);
    const std::string key = argument.substr(0, argument.find('=') + 1);
    std::erase_if(request_.assignments,
                  [&](const std::string& given) { return given.starts_with(key); });
    request_.assignments.push_back(argument);
    return "";
  }
  if (name == "restart") {
    const auto shown = player_.status().shown;
    player_.restart(request_, argument == "here" ? shown.value_or(0) : 0);
    return "";
  }
  if (name == "save") {
    player_.save(argument.empty() ? output_folder_ / file_name("")
                                  : std::filesystem::path(argument));
    return "";
  }
  known = false;
  return "";
}

/// "drive-frame-000120.png", with a number behind it if that is taken.
std::string Console::file_name(const std::string& extension) const {
  const std::string stem = fmt::format("{}-frame-{:06}", player_.recording().info().name,
                                       player_.status().shown.value_or(0));
  std::string name = stem + extension;
  for (int i = 2; std::filesystem::exists(output_folder_ / name); ++i) {
    name = fmt::format("{}-{}{}", stem, i, extension);
  }
  return name;
}

std::filesystem::path Console::take_screenshot_request() { return std::exchange(screenshot_, {}); }

}  // namespace traverse::app
