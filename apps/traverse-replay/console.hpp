#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "traverse/pipeline/preset.hpp"
#include "traverse/replay/player.hpp"

#include "view_settings.hpp"

namespace traverse::app {

/// The one way in which keys, buttons and scripts make something happen: words with an argument,
/// those of a script (replay::kScriptWords) and few more. What is not the player's is here too.
class Console {
 public:
  Console(replay::Player& player, pipeline::PresetRequest request,
          std::filesystem::path output_folder);

  /// Does what the word says. \returns an empty string, or what is wrong with it
  std::string execute(const std::string& name, const std::string& argument = "");

  replay::Player& player() { return player_; }
  const ViewSettings& view() const { return view_; }
  const pipeline::PresetRequest& request() const { return request_; }

  /// The picture that waits to be taken; empty if none does. Taking it clears it.
  std::filesystem::path take_screenshot_request();
  bool wants_to_quit() const { return quit_; }

  /// The last thing that was said to the user here; the player has its own message.
  const std::string& message() const { return message_; }
  void say(std::string message) { message_ = std::move(message); }

 private:
  std::string play_word(const std::string& name, const std::string& argument, bool& known);
  std::string view_word(const std::string& name, const std::string& argument, bool& known);
  std::string estimator_word(const std::string& name, const std::string& argument, bool& known);
  std::string set_speed(const std::string& argument);
  std::string set_range(const std::string& argument);
  std::string show_layer(const std::string& argument);
  std::string file_name(const std::string& extension) const;

  replay::Player& player_;
  pipeline::PresetRequest request_;
  std::filesystem::path output_folder_;
  ViewSettings view_;
  std::filesystem::path screenshot_;
  std::string message_;
  bool quit_ = false;
};

}  // namespace traverse::app
