#pragma once

#include <string>

#include <yaml-cpp/yaml.h>

#include "traverse/config/document.hpp"

namespace traverse::config {

/// A YAML node and, for each of its keys, where it came from: overlays mix several files.
class Document::Tree {
 public:
  struct Entry {
    std::string key;
    std::string origin;  ///< file, or "--set"
    int line = 0;        ///< from 1; 0 when the origin has no lines
    YAML::Node scalar_or_sequence;
    std::vector<Entry> children;  ///< of a mapping
    bool is_mapping = false;

    const Entry* find(std::string_view name) const;
    Entry* find(std::string_view name);
  };

  Entry root;
};

}  // namespace traverse::config
