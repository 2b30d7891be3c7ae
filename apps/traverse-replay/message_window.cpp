#include "message_window.hpp"

#include <nanogui/nanogui.h>
#include <nanogui/opengl.h>

#include "look.hpp"

namespace traverse::app {

namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 240;
constexpr int kMargin = 20;
constexpr double kWait = 0.05;

bool is_closing_key(GLFWwindow* window) {
  for (const int key : {GLFW_KEY_Q, GLFW_KEY_ESCAPE, GLFW_KEY_ENTER}) {
    if (glfwGetKey(window, key) == GLFW_PRESS) return true;
  }
  return false;
}

}  // namespace

void show_message(const std::string& title, const std::string& message) {
  if (glfwInit() == GLFW_FALSE) return;
  nanogui::init();
  {
    nanogui::ref<nanogui::Screen> screen =
        new nanogui::Screen({kWidth, kHeight}, title, /*resizable=*/true);
    screen->setTheme(window_theme(screen->nvgContext()).get());
    auto* window = new nanogui::Window(screen.get(), title);
    window->setLayout(new nanogui::BoxLayout(nanogui::Orientation::Vertical,
                                             nanogui::Alignment::Fill, kMargin, kMargin));
    window->setFixedSize({kWidth, kHeight});
    auto* text = new nanogui::Label(window, message);
    text->setFixedWidth(kWidth - 2 * kMargin);
    bool open = true;
    auto* close = new nanogui::Button(window, "Close");
    close->setCallback([&open] { open = false; });
    screen->performLayout();
    screen->setVisible(true);
    glfwSetInputMode(screen->glfwWindow(), GLFW_STICKY_KEYS, GLFW_TRUE);
    while (open && glfwWindowShouldClose(screen->glfwWindow()) == 0) {
      if (is_closing_key(screen->glfwWindow())) break;
      screen->drawAll();
      glfwWaitEventsTimeout(kWait);
    }
  }
  nanogui::shutdown();
}

}  // namespace traverse::app
