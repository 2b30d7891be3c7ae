#include "traverse/config/settings.hpp"

#include <type_traits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include "traverse/files/numbers.hpp"

#include "range_text.hpp"

namespace traverse::config {

namespace {

class Lister : public Binder {
 public:
  void number(std::string_view key, double& value, Range range, std::string_view meaning) override {
    add(key, value, meaning, range_text(range));
  }
  void integer(std::string_view key, std::int64_t& value, Range range,
               std::string_view meaning) override {
    add(key, value, meaning, range_text(range));
  }
  void flag(std::string_view key, bool& value, std::string_view meaning) override {
    add(key, value, meaning, "true | false");
  }
  void text(std::string_view key, std::string& value, std::string_view meaning) override {
    add(key, value, meaning, "");
  }
  void numbers(std::string_view key, std::vector<double>& value,
               std::string_view meaning) override {
    add(key, value, meaning, "");
  }
  void word(std::string_view key, std::string& value, std::span<const std::string_view> allowed,
            std::string_view meaning) override {
    add(key, value, meaning, fmt::format("{}", fmt::join(allowed, " | ")));
  }
  void group(std::string_view key, std::string_view,
             const std::function<void(Binder&)>& body) override {
    const std::string outer = std::exchange(prefix_, prefix_ + std::string(key) + ".");
    body(*this);
    prefix_ = outer;
  }

  std::vector<Setting> settings;

 private:
  void add(std::string_view key, Setting::Value value, std::string_view meaning,
           std::string allowed) {
    settings.push_back(
        {prefix_ + std::string(key), std::move(value), std::string(meaning), std::move(allowed)});
  }

  std::string prefix_;
};

std::string yaml_scalar(const std::string& text) {
  YAML::Emitter emitter;
  emitter << text;
  return emitter.c_str();
}

}  // namespace

std::vector<Setting> list(const Bind& bind) {
  Lister lister;
  bind(lister);
  return std::move(lister.settings);
}

std::string to_text(const Setting::Value& value) {
  return std::visit(
      [](const auto& held) -> std::string {
        using Held = std::decay_t<decltype(held)>;
        if constexpr (std::is_same_v<Held, bool>) {
          return held ? "true" : "false";
        } else if constexpr (std::is_same_v<Held, std::int64_t>) {
          return std::to_string(held);
        } else if constexpr (std::is_same_v<Held, double>) {
          return files::to_text(held);
        } else if constexpr (std::is_same_v<Held, std::string>) {
          return yaml_scalar(held);
        } else {
          std::vector<std::string> items;
          for (const double item : held) items.push_back(files::to_text(item));
          return fmt::format("[{}]", fmt::join(items, ", "));
        }
      },
      value);
}

std::string to_yaml(const Bind& bind, bool with_meanings) {
  std::string yaml;
  std::vector<std::string> open;  // the groups that the last line stood in
  for (const Setting& setting : list(bind)) {
    std::vector<std::string> groups;
    std::string_view rest = setting.path;
    for (std::size_t dot = rest.find('.'); dot != std::string_view::npos; dot = rest.find('.')) {
      groups.emplace_back(rest.substr(0, dot));
      rest.remove_prefix(dot + 1);
    }
    std::size_t common = 0;
    while (common < groups.size() && common < open.size() && groups[common] == open[common]) {
      ++common;
    }
    for (std::size_t i = common; i < groups.size(); ++i) {
      yaml += std::string(2 * i, ' ') + groups[i] + ":\n";
    }
    open = groups;
    yaml +=
        fmt::format("{}{}: {}", std::string(2 * groups.size(), ' '), rest, to_text(setting.value));
    if (with_meanings) {
      yaml += "  # " + setting.meaning;
      if (!setting.allowed.empty()) yaml += " (" + setting.allowed + ")";
    }
    yaml += "\n";
  }
  return yaml;
}

}  // namespace traverse::config
