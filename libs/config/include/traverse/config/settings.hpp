#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "traverse/config/binder.hpp"

namespace traverse::config {

/// One resolved setting.
struct Setting {
  using Value = std::variant<bool, std::int64_t, double, std::string, std::vector<double>>;

  std::string path;  ///< "features.edge_threshold"
  Value value;
  std::string meaning;  ///< what it is, with its unit
  std::string allowed;  ///< "0 .. 1", "scalar | vector", or empty for anything
};

/// Every bound setting with its present value, in order.
std::vector<Setting> list(const Bind& bind);

/// `value` as YAML and as a reader expects it: true, 3, 0.25, text, [1, 2].
std::string to_text(const Setting::Value& value);

/// The settings as a YAML mapping, with each meaning as a comment when asked.
std::string to_yaml(const Bind& bind, bool with_meanings);

}  // namespace traverse::config
