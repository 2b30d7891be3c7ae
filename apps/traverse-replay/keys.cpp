#include "keys.hpp"

#include <algorithm>
#include <array>
#include <nanogui/opengl.h>
#include <string>

#include "console.hpp"

namespace traverse::app {

namespace {

struct Key {
  int key;
  int modifiers;  // shift and control as they must be
  const char* word;
  const char* argument;
};

constexpr int kShift = GLFW_MOD_SHIFT;
constexpr int kControl = GLFW_MOD_CONTROL;

constexpr std::array<Key, 24> kKeys{{
    {GLFW_KEY_SPACE, 0, "toggle", ""},
    {GLFW_KEY_LEFT, 0, "step", "-1"},
    {GLFW_KEY_RIGHT, 0, "step", "1"},
    {GLFW_KEY_LEFT, kShift, "step", "-10"},
    {GLFW_KEY_RIGHT, kShift, "step", "10"},
    {GLFW_KEY_HOME, 0, "home", ""},
    {GLFW_KEY_END, 0, "end", ""},
    {GLFW_KEY_LEFT_BRACKET, 0, "slower", ""},
    {GLFW_KEY_RIGHT_BRACKET, 0, "faster", ""},
    {GLFW_KEY_M, 0, "speed", "max"},
    {GLFW_KEY_M, kShift, "speed", "1"},
    {GLFW_KEY_L, 0, "loop", "toggle"},
    {GLFW_KEY_I, 0, "range", "from-here"},
    {GLFW_KEY_O, 0, "range", "to-here"},
    {GLFW_KEY_P, 0, "range", "off"},
    {GLFW_KEY_F, 0, "view", "follow"},
    {GLFW_KEY_T, 0, "view", "top"},
    {GLFW_KEY_V, 0, "view", "free"},
    {GLFW_KEY_R, 0, "restart", "here"},
    {GLFW_KEY_R, kShift, "restart", "start"},
    {GLFW_KEY_S, 0, "screenshot", ""},
    {GLFW_KEY_S, kControl, "save", ""},
    {GLFW_KEY_H, 0, "help", ""},
    {GLFW_KEY_Q, 0, "quit", ""},
}};

void next_colour(Console& console) {
  const auto now = static_cast<std::size_t>(console.view().colour);
  const auto& next = replay::kScanColourNames.at((now + 1) % replay::kScanColourNames.size());
  console.execute("colour", std::string(next.first));
}

}  // namespace

bool press_key(int key, int modifiers, Console& console) {
  const int relevant = modifiers & (kShift | kControl);
  const auto found = std::find_if(kKeys.begin(), kKeys.end(), [&](const Key& known) {
    return known.key == key && known.modifiers == relevant;
  });
  if (found != kKeys.end()) {
    console.execute(found->word, found->argument);
    return true;
  }
  if (key == GLFW_KEY_C && relevant == 0) {
    next_colour(console);
    return true;
  }
  const auto layer = static_cast<std::size_t>(key - GLFW_KEY_1);
  if (key >= GLFW_KEY_1 && layer < kLayerNames.size() && relevant == 0) {
    const bool on = !console.view().layers[layer];
    console.execute("show", std::string(kLayerNames[layer]) + (on ? " on" : " off"));
    return true;
  }
  return false;
}

}  // namespace traverse::app
