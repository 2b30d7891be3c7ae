#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

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
    std::vector<Entry> children;                             ///< of a mapping; they grow by add()
    std::map<std::string, std::size_t, std::less<>> places;  ///< of many children, by their keys
    bool is_mapping = false;

    void add(Entry child);  ///< whose key is not there yet
    const Entry* find(std::string_view name) const;
    Entry* find(std::string_view name);
  };

  Entry root;
};

}  // namespace traverse::config
