#pragma once

namespace traverse::app {

class Console;

/// Does what a key of the keyboard stands for; `key` and `modifiers` are GLFW's.
/// \returns whether it stands for anything
bool press_key(int key, int modifiers, Console& console);

}  // namespace traverse::app
