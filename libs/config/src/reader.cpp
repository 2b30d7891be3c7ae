#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/config/document.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/numbers.hpp"

#include "range_text.hpp"
#include "tree.hpp"

namespace traverse::config {

using files::InputError;
using files::Place;
using Entry = Document::Tree::Entry;

namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, substituted});
    }
  }
  return row.back();
}

/// Reads one mapping level; remembers which keys were bound, to name those that were not.
class Reader : public Binder {
 public:
  Reader(const Entry& mapping, std::string prefix, std::vector<std::string>& notes)
      : mapping_(mapping), prefix_(std::move(prefix)), notes_(notes) {}

  void number(std::string_view key, double& value, Range range, std::string_view) override {
    const Entry* entry = take(key);
    if (entry == nullptr) return;
    const auto parsed = files::parse_double(scalar_of(*entry));
    if (!parsed || !std::isfinite(*parsed) || *parsed < range.least || *parsed > range.most) {
      throw wrong(*entry, "a number" + range_suffix(range));
    }
    value = *parsed;
  }

  void integer(std::string_view key, std::int64_t& value, Range range, std::string_view) override {
    const Entry* entry = take(key);
    if (entry == nullptr) return;
    const auto parsed = files::parse_integer(scalar_of(*entry));
    if (!parsed || static_cast<double>(*parsed) < range.least ||
        static_cast<double>(*parsed) > range.most) {
      throw wrong(*entry, "a whole number" + range_suffix(range));
    }
    value = *parsed;
  }

  void flag(std::string_view key, bool& value, std::string_view) override {
    const Entry* entry = take(key);
    if (entry == nullptr) return;
    const std::string text = scalar_of(*entry);
    if (text != "true" && text != "false") throw wrong(*entry, "true or false");
    value = text == "true";
  }

  void text(std::string_view key, std::string& value, std::string_view) override {
    const Entry* entry = take(key);
    if (entry == nullptr) return;
    if (!entry->scalar_or_sequence.IsScalar()) throw wrong(*entry, "a text");
    value = entry->scalar_or_sequence.Scalar();
  }

  void numbers(std::string_view key, std::vector<double>& value, std::string_view) override {
    const Entry* entry = take(key);
    if (entry == nullptr) return;
    if (!entry->scalar_or_sequence.IsSequence()) throw wrong(*entry, "a list of numbers");
    std::vector<double> parsed;
    for (const auto& item : entry->scalar_or_sequence) {
      const auto number = item.IsScalar() ? files::parse_double(item.Scalar()) : std::nullopt;
      if (!number || !std::isfinite(*number)) throw wrong(*entry, "a list of numbers only");
      parsed.push_back(*number);
    }
    value = std::move(parsed);
  }

  void word(std::string_view key, std::string& value, std::span<const std::string_view> allowed,
            std::string_view) override {
    const Entry* entry = take(key);
    if (entry == nullptr) return;
    const std::string text = scalar_of(*entry);
    if (std::find(allowed.begin(), allowed.end(), text) == allowed.end()) {
      throw wrong(*entry, fmt::format("one of {}", fmt::join(allowed, ", ")));
    }
    value = text;
  }

  void group(std::string_view key, std::string_view,
             const std::function<void(Binder&)>& body) override {
    static const Entry kEmpty{{}, {}, 0, {}, {}, {}, true};
    const Entry* entry = take(key);
    if (entry != nullptr && !entry->is_mapping) throw wrong(*entry, "a mapping");
    Reader reader(entry != nullptr ? *entry : kEmpty, path(key) + ".", notes_);
    body(reader);
    reader.reject_unbound();
  }

  void read_elsewhere(std::string_view key) { bound_.emplace(key); }

  void reject_unbound() const {
    for (const Entry& child : mapping_.children) {
      if (bound_.contains(child.key)) continue;
      throw InputError(child.origin, place_of(child),
                       bound_.empty() ? "no key here" : "a known key" + nearest(child.key),
                       files::in_quotes(path(child.key)));
    }
  }

 private:
  const Entry* take(std::string_view key) {
    bound_.emplace(key);
    const std::string former = former_name(key);
    const Entry* old = former.empty() ? nullptr : mapping_.find(former);
    if (old == nullptr) return mapping_.find(key);
    bound_.emplace(former);
    const Entry* entry = mapping_.find(key);
    notes_.push_back(fmt::format("{}: '{}' is called '{}' now{}", place_text(*old), path(former),
                                 path(key),
                                 entry == nullptr ? "" : ", which is given too and wins"));
    return entry == nullptr ? old : entry;
  }

  /// What a limit was called up to version 0.1: least_ for min_, most_ for max_.
  static std::string former_name(std::string_view key) {
    if (key.starts_with("min_")) return fmt::format("least_{}", key.substr(4));
    if (key.starts_with("max_")) return fmt::format("most_{}", key.substr(4));
    return "";
  }

  static std::string place_text(const Entry& entry) {
    return entry.line > 0 ? fmt::format("{}, line {}", entry.origin, entry.line) : entry.origin;
  }

  std::string path(std::string_view key) const { return prefix_ + std::string(key); }

  std::string scalar_of(const Entry& entry) const {
    if (entry.is_mapping || !entry.scalar_or_sequence.IsScalar()) throw wrong(entry, "one value");
    return entry.scalar_or_sequence.Scalar();
  }

  static Place place_of(const Entry& entry) {
    return entry.line > 0 ? Place::line(static_cast<std::size_t>(entry.line)) : Place{};
  }

  InputError wrong(const Entry& entry, const std::string& expected) const {
    const std::string found =
        entry.is_mapping ? "a mapping" : files::in_quotes(YAML::Dump(entry.scalar_or_sequence));
    return {entry.origin, place_of(entry), expected + " for '" + path(entry.key) + "'", found};
  }

  std::string nearest(const std::string& key) const {
    const auto best =
        std::min_element(bound_.begin(), bound_.end(), [&](const auto& a, const auto& b) {
          return edit_distance(a, key) < edit_distance(b, key);
        });
    return edit_distance(*best, key) <= 1 + key.size() / 3
               ? " (did you mean '" + path(*best) + "'?)"
               : fmt::format(" ({})", fmt::join(bound_, ", "));
  }

  const Entry& mapping_;
  std::string prefix_;
  std::vector<std::string>& notes_;
  std::set<std::string, std::less<>> bound_;
};

}  // namespace

std::vector<std::string> read(const Document& document, const Bind& bind,
                              std::span<const std::string_view> others) {
  std::vector<std::string> notes;
  Reader reader(document.tree().root, "", notes);
  for (const std::string_view key : others) reader.read_elsewhere(key);
  bind(reader);
  reader.reject_unbound();
  return notes;
}

}  // namespace traverse::config
