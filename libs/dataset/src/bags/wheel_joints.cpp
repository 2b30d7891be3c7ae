#include "bags/wheel_joints.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "bags/ros_messages.hpp"

namespace traverse::dataset {

namespace {

/// The words of a joint's name in small letters: "FrontLeft_wheel-joint" is front, left, wheel,
/// joint.
std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words;
  bool was_small = false;
  bool is_open = false;
  for (const char c : name) {
    const auto letter = static_cast<unsigned char>(c);
    if (std::isalpha(letter) == 0) {
      is_open = false;
      continue;
    }
    const bool is_capital = std::isupper(letter) != 0;
    if (!is_open || (is_capital && was_small)) words.emplace_back();
    words.back().push_back(static_cast<char>(std::tolower(letter)));
    was_small = !is_capital;
    is_open = true;
  }
  return words;
}

bool has_word(const std::vector<std::string>& words, std::initializer_list<const char*> any) {
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    return std::find(any.begin(), any.end(), word) != any.end();
  });
}

bool has_part(const std::vector<std::string>& words, std::initializer_list<const char*> any) {
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    return std::any_of(any.begin(), any.end(),
                       [&](const char* part) { return word.find(part) != std::string::npos; });
  });
}

struct Side {
  std::vector<std::string> all;
  std::vector<std::string> rear;

  /// The only one.
  std::optional<std::string> wheel() const {
    if (all.size() == 1) return all.front();
    if (rear.size() == 1) return rear.front();
    return std::nullopt;
  }
};

}  // namespace

void bind(config::Binder& b, WheelJointStatements& v) {
  b.text("left_joint", v.left_joint, "of a bag's JointState");
  b.text("right_joint", v.right_joint, "of a bag's JointState");
  b.number("radius_m", v.radius_m, config::Range::between(0, 100), "of the wheels of a JointState");
}

std::vector<std::string> joints_in(const bags::MessageValue& message) {
  std::vector<std::string> names;
  message["name"].for_each(
      [&](const bags::MessageValue& name) { names.emplace_back(name.text()); });
  return names;
}

std::optional<WheelJoints> wheel_joints_of(const std::vector<std::string>& names,
                                           const WheelJointStatements& stated) {
  Side left;
  Side right;
  for (const std::string& name : names) {
    const std::vector<std::string> words = words_of(name);
    if (!has_part(words, {"wheel", "whl"}) || has_part(words, {"steer", "caster", "susp"})) {
      continue;
    }
    const bool is_left = has_part(words, {"left"}) || has_word(words, {"l", "fl", "rl", "bl"});
    const bool is_right = has_part(words, {"right"}) || has_word(words, {"r", "fr", "rr", "br"});
    if (is_left == is_right) continue;
    Side& side = is_left ? left : right;
    side.all.push_back(name);
    const bool is_rear =
        has_part(words, {"rear", "back"}) || has_word(words, {"rl", "rr", "bl", "br"});
    if (is_rear) side.rear.push_back(name);
  }
  const auto taken = [&](const std::string& statement,
                         const Side& side) -> std::optional<std::string> {
    if (statement.empty()) return side.wheel();
    if (std::count(names.begin(), names.end(), statement) == 0) return std::nullopt;
    return statement;
  };
  auto left_wheel = taken(stated.left_joint, left);
  auto right_wheel = taken(stated.right_joint, right);
  if (!left_wheel || !right_wheel) return std::nullopt;
  return WheelJoints{std::move(*left_wheel), std::move(*right_wheel)};
}

sensors::WheelOdometry wheel_angles_of(const bags::MessageValue& message,
                                       const WheelJoints& wheels) {
  constexpr double kMostRadians = 1e12;
  const std::vector<std::string> names = joints_in(message);
  const bags::NumberColumn angles = message["position"].numbers();
  const auto pulses = [&](const std::string& joint) {
    const auto index =
        static_cast<std::size_t>(std::find(names.begin(), names.end(), joint) - names.begin());
    if (index == names.size()) {
      throw UnusableMessage("joints without one that is a wheel");
    }
    if (index >= angles.count || !(std::abs(angles[index]) < kMostRadians)) {
      throw UnusableMessage("joints without the angle of a wheel");
    }
    return static_cast<std::int64_t>(std::llround(angles[index] * kPulsesPerRadian));
  };
  sensors::WheelOdometry odometry;
  odometry.ticks = {pulses(wheels.left), pulses(wheels.right)};
  return odometry;
}

}  // namespace traverse::dataset
