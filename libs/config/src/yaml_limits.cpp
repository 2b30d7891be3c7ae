#include "yaml_limits.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <sstream>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include "traverse/files/input_error.hpp"

namespace traverse::config {

using files::InputError;
using files::Place;

namespace {

constexpr std::size_t kDeepestNesting = 32;
/// A node of yaml-cpp takes three quarters of a kilobyte, and two bytes of a file may be one.
constexpr std::uint64_t kMostValues = 40'000;
constexpr std::uint64_t kMostText = std::uint64_t{4} << 20;  // bytes
constexpr std::size_t kLongest = std::size_t{1} << 20;       // bytes of a document
/// yaml-cpp keeps every token of what stands in brackets, since all of it might be a key.
constexpr std::size_t kLongestInBrackets = std::size_t{1} << 17;

/// Measures a document as it would be with each alias written out: a few lines of aliases of
/// aliases are billions of values.
class Measure final : public YAML::EventHandler {
 public:
  explicit Measure(const std::string& origin) : origin_(origin) {}

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { scalar(mark, anchor, 0); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                const std::string& value) override {
    scalar(mark, anchor, value.size());
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = sizes_.find(anchor);
    if (found == sizes_.end()) {
      throw error(mark, "an alias of a value that is complete", "one of what it stands in");
    }
    add(mark, found->second);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(mark, anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(mark, anchor);
  }
  void OnMapEnd() override { close(); }

 private:
  struct Size {
    std::uint64_t values = 0;
    std::uint64_t text = 0;
  };
  struct Open {
    YAML::anchor_t anchor = YAML::NullAnchor;
    Size before;  ///< what stood before it
  };

  void scalar(const YAML::Mark& mark, YAML::anchor_t anchor, std::size_t length) {
    const Size size{1, length};
    add(mark, size);
    if (anchor != YAML::NullAnchor) sizes_[anchor] = size;
  }

  void open(const YAML::Mark& mark, YAML::anchor_t anchor) {
    if (open_.size() == kDeepestNesting) throw error(mark, "less deeply nested keys", "more");
    open_.push_back({anchor, all_});
    add(mark, {1, 0});
  }

  void close() {
    const Open closed = open_.back();
    open_.pop_back();
    if (closed.anchor == YAML::NullAnchor) return;
    sizes_[closed.anchor] = {all_.values - closed.before.values, all_.text - closed.before.text};
  }

  /// Both sums stay far below what 64 bits hold: each step adds at most what is allowed in all.
  void add(const YAML::Mark& mark, const Size& size) {
    all_.values += size.values;
    all_.text += size.text;
    if (all_.values > kMostValues) {
      throw error(mark, fmt::format("at most {} keys and values, aliases written out", kMostValues),
                  "more");
    }
    if (all_.text > kMostText) {
      throw error(mark, fmt::format("at most {} bytes of text, aliases written out", kMostText),
                  "more");
    }
  }

  InputError error(const YAML::Mark& mark, std::string expected, std::string found) const {
    return {origin_, Place::line(static_cast<std::size_t>(mark.line + 1)), std::move(expected),
            std::move(found)};
  }

  const std::string& origin_;
  Size all_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, Size> sizes_;  ///< of the values that aliases may repeat
};

/// What is read before there are values to measure. Brackets in texts count too, which does no
/// harm: they do not stand so far apart.
void check_length(const std::string& yaml, const std::string& origin) {
  if (yaml.size() > kLongest) {
    throw InputError(origin, Place::whole_file(), fmt::format("YAML of at most {} bytes", kLongest),
                     fmt::format("{} bytes", yaml.size()));
  }
  std::size_t line = 1;
  std::size_t depth = 0;
  std::size_t opened = 0;
  for (std::size_t i = 0; i < yaml.size(); ++i) {
    const char c = yaml[i];
    if (c == '\n') ++line;
    if (c == '[' || c == '{') {
      if (depth++ == 0) opened = i;
    } else if ((c == ']' || c == '}') && depth > 0) {
      --depth;
    }
    if (depth > 0 && i - opened > kLongestInBrackets) {
      throw InputError(
          origin, Place::line(line),
          fmt::format("at most {} bytes between brackets (longer lists an item a line, with '-')",
                      kLongestInBrackets),
          "more");
    }
  }
}

}  // namespace

void check_yaml(const std::string& yaml, const std::string& origin) {
  check_length(yaml, origin);
  std::istringstream stream(yaml);
  Measure measure(origin);
  try {
    YAML::Parser(stream).HandleNextDocument(measure);
  } catch (const YAML::Exception& error) {
    throw InputError(origin, Place::line(static_cast<std::size_t>(error.mark.line + 1)),
                     "valid YAML", error.msg);
  }
}

}  // namespace traverse::config
