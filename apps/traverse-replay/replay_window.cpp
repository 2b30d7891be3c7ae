#include "replay_window.hpp"

#include <algorithm>
#include <cmath>
#include <nanogui/opengl.h>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "traverse/render/image.hpp"

#include "help_overlay.hpp"
#include "keys.hpp"
#include "look.hpp"
#include "panel.hpp"
#include "transport_bar.hpp"

namespace traverse::app {

namespace {

constexpr double kTextsEvery = 0.1;    // seconds: numbers that change faster cannot be read
constexpr double kIdleRedraw = 0.25;   // seconds, when nothing happens
constexpr double kEventRedraws = 0.5;  // seconds after the last mouse or key
constexpr double kShortestRedraw = 1.0 / 60;
constexpr double kWait = 0.004;
constexpr double kSmoothing = 0.1;
constexpr float kFollowDistance = 55;
constexpr float kFollowElevation = 28;
constexpr float kTopDistance = 90;
constexpr int kHelpLeft = 24;
constexpr int kHelpTop = 24;

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

double heading_of(const geometry::Pose3& T_map_body) {
  return std::atan2(T_map_body.rotation(1, 0), T_map_body.rotation(0, 0));
}

double seconds_since(std::chrono::steady_clock::time_point then) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - then).count();
}

mrpt::gui::CDisplayWindowGUI_Params window_parameters() {
  mrpt::gui::CDisplayWindowGUI_Params parameters;
  parameters.resizable = true;
  return parameters;
}

}  // namespace

ReplayWindow::ReplayWindow(Console& console, const std::string& title, int width, int height)
    : mrpt::gui::CDisplayWindowGUI(title, static_cast<unsigned>(width),
                                   static_cast<unsigned>(height), window_parameters()),
      console_(console),
      title_(title),
      scale_(Scene::scale_of(console.player().recording())),
      scene_(scale_) {
  setTheme(window_theme(nvgContext()).get());
  {
    const std::lock_guard lock(background_scene_mtx);
    background_scene = scene_.mrpt_scene();
  }
  camera().setMaximumZoom(5000);
  panel_ = new Panel(this, console);
  transport_ = new TransportBar(this, console);
  help_ = new HelpOverlay(this);
  performLayout();
  panel_->refresh({});
  transport_->refresh("");
  arrange();
}

ReplayWindow::~ReplayWindow() = default;

void ReplayWindow::arrange() {
  performLayout();
  const nanogui::Vector2i all = size();
  const int view_width = std::max(1, all.x() - Panel::kWidth);
  const int view_height = std::max(1, all.y() - TransportBar::kHeight);
  panel_->fold_to_fit(view_height);
  panel_->setPosition({view_width, 0});
  panel_->setSize({Panel::kWidth, view_height});
  transport_->setPosition({0, view_height});
  transport_->setSize({all.x(), TransportBar::kHeight});
  transport_->performLayout(nvgContext());
  panel_->performLayout(nvgContext());
  help_->setPosition({kHelpLeft, kHelpTop});
  help_->setSize(help_->preferredSize(nvgContext()));
  scene_.set_view(static_cast<double>(view_width) / all.x(),
                  static_cast<double>(view_height) / all.y(),
                  static_cast<double>(TransportBar::kHeight) / all.y());
}

bool ReplayWindow::round() {
  glfwWaitEventsTimeout(kWait);
  const replay::PlayerStatus status = console_.player().status();
  if (was_playing_ && status.playing) {
    report_.longest_s = std::max(report_.longest_s, seconds_since(last_round_));
  }
  last_round_ = Clock::now();

  const bool is_new = scene_.update(console_.player(), console_.view());
  const double since_drawn = seconds_since(last_drawn_);
  const bool is_due = is_new || status.playing || seconds_since(last_event_) < kEventRedraws ||
                      since_drawn > kIdleRedraw;
  if (is_due && since_drawn >= kShortestRedraw) {
    const double before = report_.seconds;
    const auto begin = Clock::now();
    drawAll();
    note_redraw(seconds_since(begin), status.playing && was_playing_);
    if (status.playing && was_playing_) report_.seconds = before + since_drawn;
    last_drawn_ = begin;
  }
  was_playing_ = status.playing;
  take_screenshot();
  const bool is_closed = glfwWindowShouldClose(glfwWindow()) != 0;
  return !is_closed && !console_.wants_to_quit();
}

void ReplayWindow::note_redraw(double seconds, bool playing) {
  report_.redraws += playing ? 1 : 0;
  report_.max_points = std::max(report_.max_points, scene_.points_drawn());
  redraw_s_ += kSmoothing * (seconds - redraw_s_);
  scene_.adapt(redraw_s_);
  while (glGetError() != GL_NO_ERROR) ++report_.gl_errors;
}

void ReplayWindow::drawAll() {
  if (size() != nanogui::Vector2i(panel_->position().x() + Panel::kWidth,
                                  transport_->position().y() + TransportBar::kHeight)) {
    arrange();
  }
  if (seconds_since(last_texts_) > kTextsEvery) refresh_texts();
  help_->setVisible(console_.view().help);
  move_camera();
  CDisplayWindowGUI::drawAll();
}

void ReplayWindow::refresh_texts() {
  last_texts_ = Clock::now();
  const std::string pipeline = console_.player().status().pipeline;
  if (pipeline != titled_) setCaption(title_ + " (" + pipeline + ")");
  titled_ = pipeline;
  panel_->refresh(scene_.legend());
  transport_->refresh(
      fmt::format("{:.0f} thousand points drawn of a map of {:.0f} thousand, "
                  "{:.0f} ms a redraw",
                  static_cast<double>(scene_.points_drawn()) / 1000,
                  static_cast<double>(scene_.map_points()) / 1000, 1000 * redraw_s_));
}

void ReplayWindow::move_camera() {
  const auto shown = console_.player().shown();
  if (!shown) return;
  const geometry::Pose3& T_map_body = shown->pose.T_map_body;
  const double heading = heading_of(T_map_body);
  auto& view = camera();
  const CameraMode mode = console_.view().camera;
  const bool is_switched = !camera_is_placed_ || mode != camera_;
  if (is_switched && mode == CameraMode::kFollow) {
    view.setCameraProjective(true);
    view.setZoomDistance(kFollowDistance * static_cast<float>(scale_));
    view.setElevationDegrees(kFollowElevation);
    view.setAzimuthDegrees(static_cast<float>(degrees(heading) + 180));
  } else if (is_switched && mode == CameraMode::kTop) {
    view.setCameraProjective(false);
    view.setZoomDistance(kTopDistance * static_cast<float>(scale_));
    view.setElevationDegrees(90);
    view.setAzimuthDegrees(-90);
  } else if (is_switched) {
    view.setCameraProjective(true);
  } else if (mode == CameraMode::kFollow) {
    view.setAzimuthDegrees(
        view.getAzimuthDegrees() +
        static_cast<float>(degrees(std::remainder(heading - heading_, 2 * std::numbers::pi))));
  }
  if (mode != CameraMode::kFree || is_switched) {
    const Eigen::Vector3f p = T_map_body.translation.cast<float>();
    view.setCameraPointing(p.x(), p.y(), p.z());
  }
  heading_ = heading;
  camera_ = mode;
  camera_is_placed_ = true;
}

void ReplayWindow::take_screenshot() {
  const std::filesystem::path file = console_.take_screenshot_request();
  if (file.empty()) return;
  try {
    write_screenshot(file);
    console_.say("screenshot " + file.string());
  } catch (const std::exception& error) {
    console_.say(std::string("no screenshot: ") + error.what());
  }
}

void ReplayWindow::write_screenshot(const std::filesystem::path& file) {
  scene_.update(console_.player(), console_.view());
  move_camera();
  refresh_texts();
  help_->setVisible(console_.view().help);
  // As drawAll() does, but read before the buffers are swapped: behind that they are undefined.
  glClearColor(0, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  drawContents();
  drawWidgets();
  render::Image image;
  image.width = mFBSize.x();
  image.height = mFBSize.y();
  const auto row = static_cast<std::size_t>(image.width) * 3;
  std::vector<std::uint8_t> bottom_up(row * static_cast<std::size_t>(image.height));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadBuffer(GL_BACK);
  glReadPixels(0, 0, image.width, image.height, GL_RGB, GL_UNSIGNED_BYTE, bottom_up.data());
  image.rgb.resize(bottom_up.size());
  for (std::size_t y = 0; y < static_cast<std::size_t>(image.height); ++y) {
    const std::size_t from = (static_cast<std::size_t>(image.height) - 1 - y) * row;
    std::copy_n(bottom_up.begin() + static_cast<std::ptrdiff_t>(from), row,
                image.rgb.begin() + static_cast<std::ptrdiff_t>(y * row));
  }
  image.write_png(file);
}

bool ReplayWindow::resizeEvent(const nanogui::Vector2i& new_size) {
  const bool handled = CDisplayWindowGUI::resizeEvent(new_size);
  arrange();
  return handled;
}

bool ReplayWindow::keyboardEvent(int key, int scancode, int action, int modifiers) {
  last_event_ = Clock::now();
  if (CDisplayWindowGUI::keyboardEvent(key, scancode, action, modifiers)) return true;
  if (key == GLFW_KEY_G && action == GLFW_RELEASE) {  // pressed, the box would get the letter too
    transport_->ask_where_to_go();
    return true;
  }
  if (action == GLFW_RELEASE) return false;
  return press_key(key, modifiers, console_);
}

bool ReplayWindow::is_over_view(const nanogui::Vector2i& p) const {
  return p.x() < panel_->position().x() && p.y() < transport_->position().y();
}

bool ReplayWindow::mouseButtonEvent(const nanogui::Vector2i& p, int button, bool down,
                                    int modifiers) {
  last_event_ = Clock::now();
  if (down && is_over_view(p)) updateFocus(nullptr);  // keys are the window's again
  return CDisplayWindowGUI::mouseButtonEvent(p, button, down, modifiers);
}

}  // namespace traverse::app
