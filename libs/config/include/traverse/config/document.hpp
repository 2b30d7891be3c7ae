#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "traverse/config/binder.hpp"

namespace traverse::config {

/// Where a setting was given.
struct Origin {
  std::string source;    ///< the file, or the argument: "--set cell_m=0.2"
  std::size_t line = 0;  ///< of the file, from 1; 0 for an argument
};

/// "drive/traverse.yaml, line 3" or "--set cell_m=0.2".
std::string to_text(const Origin& origin);

/// A key that holds no further keys.
struct Leaf {
  std::string path;  ///< "solver.huber_m", whether nested or written with dots
  std::string text;  ///< the value as YAML on one line
  std::optional<std::vector<std::string>> items;  ///< of a list, each as YAML on one line
  Origin origin;
};

/// A YAML mapping with the places of its keys, and overrides on top of it (--set key=value).
class Document {
 public:
  Document();  ///< empty
  /// \throws files::InputError with file and line if it is not YAML or not a mapping.
  static Document load(const std::filesystem::path& file);
  /// `origin` stands for the file in messages.
  static Document parse(const std::string& yaml, const std::string& origin);

  Document(Document&&) noexcept;
  Document& operator=(Document&&) noexcept;
  ~Document();

  /// Puts `document` over this one: its keys win, key by key through nested mappings.
  void overlay(const Document& document);

  /// Overrides one key: "features.edge_threshold=0.2". The value is YAML. `option` is the argument
  /// of the command line that brings it, for messages.
  /// \throws files::InputError if there is no '=' or the value is not YAML.
  void set(std::string_view assignment, std::string_view option = "--set");

  bool has(std::string_view top_level_key) const;
  /// The plain value of `top_level_key`; nothing if there is none or it is not one value.
  std::optional<std::string> scalar(std::string_view top_level_key) const;
  /// Where the key at `path` ("features.edge_threshold") was given; nothing if it was not.
  std::optional<Origin> origin(std::string_view path) const;
  /// The mapping below `top_level_key`, empty if there is none. \throws files::InputError if the
  /// key holds something else.
  Document child(std::string_view top_level_key) const;
  std::vector<std::string> keys() const;  ///< of the top level, in order
  /// The items of the list under `top_level_key`, each a mapping of its own; a plain item stands
  /// for {short_key: item}. Empty if there is no such key.
  /// \throws files::InputError if the key holds something else.
  std::vector<Document> items(std::string_view top_level_key, std::string_view short_key) const;
  /// Every key that holds a value or a list, in order, through nested mappings.
  std::vector<Leaf> leaves() const;
  /// Where the mapping itself begins.
  Origin origin() const;

  class Tree;
  const Tree& tree() const { return *tree_; }

 private:
  std::unique_ptr<Tree> tree_;
};

/// Gives each bound setting its value in `document`; settings that are not there keep theirs.
/// \throws files::InputError naming file, line, key, what is allowed and what was found, for a
/// value of the wrong type or out of range and for a key that nothing binds (with the nearest
/// known key as a hint).
/// \param others top-level keys that are no settings and are read by child() or items()
/// \returns a note for each key that was given by a former name, for the user: "presets/mine.yaml,
/// line 3: 'least_matches' is called 'min_matches' now"
std::vector<std::string> read(const Document& document, const Bind& bind,
                              std::span<const std::string_view> others = {});

}  // namespace traverse::config
