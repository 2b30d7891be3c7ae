#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace traverse::config {

/// The values a setting may take, both ends included.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();

  static constexpr Range any() { return {}; }
  static constexpr Range positive() {
    return {std::numeric_limits<double>::min(), std::numeric_limits<double>::infinity()};
  }
  static constexpr Range non_negative() { return {0, std::numeric_limits<double>::infinity()}; }
  static constexpr Range between(double least, double most) { return {least, most}; }
};

/// The one description of a settings struct, from which it is read, checked, written and listed:
///
///     struct Options { double cell_m = 0.5; bool deskew = true; };
///     void bind(config::Binder& b, Options& o) {
///       b.number("cell_m", o.cell_m, Range::positive(), "edge of a map cell, metres");
///       b.flag("deskew", o.deskew, "undo the motion within a sweep");
///     }
///     config::read(document, [&](config::Binder& b) { bind(b, options); });
///
/// Keys are snake_case with the unit as suffix where there is one (_m, _deg, _s).
class Binder {
 public:
  virtual ~Binder() = default;

  virtual void number(std::string_view key, double& value, Range range,
                      std::string_view meaning) = 0;
  virtual void integer(std::string_view key, std::int64_t& value, Range range,
                       std::string_view meaning) = 0;
  virtual void flag(std::string_view key, bool& value, std::string_view meaning) = 0;
  virtual void text(std::string_view key, std::string& value, std::string_view meaning) = 0;
  virtual void numbers(std::string_view key, std::vector<double>& value,
                       std::string_view meaning) = 0;
  /// One of `allowed`.
  virtual void word(std::string_view key, std::string& value,
                    std::span<const std::string_view> allowed, std::string_view meaning) = 0;
  /// The settings of `body` under `key`.
  virtual void group(std::string_view key, std::string_view meaning,
                     const std::function<void(Binder&)>& body) = 0;

  /// An int field, bound as integer().
  void integer(std::string_view key, int& value, Range range, std::string_view meaning) {
    std::int64_t wide = value;
    range.least = std::max(range.least, double{std::numeric_limits<int>::min()});
    range.most = std::min(range.most, double{std::numeric_limits<int>::max()});
    integer(key, wide, range, meaning);
    value = static_cast<int>(wide);
  }

  /// An enumeration by the names of its values.
  template <typename Enum, std::size_t N>
  void choice(std::string_view key, Enum& value,
              const std::array<std::pair<std::string_view, Enum>, N>& names,
              std::string_view meaning) {
    std::array<std::string_view, N> allowed;
    std::string current;
    for (std::size_t i = 0; i < N; ++i) {
      allowed[i] = names[i].first;
      if (names[i].second == value) current = names[i].first;
    }
    word(key, current, allowed, meaning);
    for (const auto& [name, named_value] : names) {
      if (name == current) value = named_value;
    }
  }
};

/// Something that presents its settings to a Binder.
using Bind = std::function<void(Binder&)>;

}  // namespace traverse::config
