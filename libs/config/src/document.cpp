#include "traverse/config/document.hpp"

#include <utility>

#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"

#include "tree.hpp"
#include "yaml_limits.hpp"

namespace traverse::config {

using files::InputError;
using files::Place;
using Entry = Document::Tree::Entry;

namespace {

Entry build(const YAML::Node& node, std::string key, const std::string& origin, int key_line) {
  Entry entry;
  entry.key = std::move(key);
  entry.origin = origin;
  entry.line = key_line;
  entry.scalar_or_sequence = node;
  entry.is_mapping = node.IsMap();
  if (!entry.is_mapping) return entry;
  for (const auto& item : node) {
    const int line = item.first.Mark().line + 1;
    const auto item_place = Place::line(static_cast<std::size_t>(line));
    if (!item.first.IsScalar()) throw InputError(origin, item_place, "a plain key", "a collection");
    const auto& name = item.first.Scalar();
    if (entry.find(name) != nullptr) {
      throw InputError(origin, item_place, "each key once", files::in_quotes(name) + " again");
    }
    entry.add(build(item.second, name, origin, line));
  }
  return entry;
}

Entry parse_mapping(const std::string& yaml, const std::string& origin) {
  check_yaml(yaml, origin);
  YAML::Node node = YAML::Load(yaml);
  if (node.IsNull()) node = YAML::Node(YAML::NodeType::Map);  // an empty file sets nothing
  if (!node.IsMap())
    throw InputError(origin, Place::line(1), "a mapping of keys to values", "none");
  return build(node, "", origin, 1);
}

Place place_of(const Entry& entry) {
  return entry.line == 0 ? Place{} : Place::line(static_cast<std::size_t>(entry.line));
}

/// An argument of the command line has no lines.
void forget_lines(Entry& entry) {
  entry.line = 0;
  for (Entry& child : entry.children) forget_lines(child);
}

void overlay_entry(Entry& base, const Entry& top) {
  if (!base.is_mapping || !top.is_mapping) {
    base = top;
    return;
  }
  for (const Entry& child : top.children) {
    if (Entry* existing = base.find(child.key)) {
      overlay_entry(*existing, child);
    } else {
      base.add(child);
    }
  }
}

std::string on_one_line(const YAML::Node& node) {
  YAML::Emitter emitter;
  emitter.SetSeqFormat(YAML::Flow);
  emitter.SetMapFormat(YAML::Flow);
  emitter << node;
  return emitter.c_str();
}

Origin origin_of(const Entry& entry) {
  return {entry.origin, static_cast<std::size_t>(entry.line)};
}

void collect_leaves(const Entry& mapping, const std::string& prefix, std::vector<Leaf>& leaves) {
  for (const Entry& child : mapping.children) {
    const std::string path = prefix + child.key;
    if (child.is_mapping) {
      collect_leaves(child, path + ".", leaves);
      continue;
    }
    const YAML::Node& node = child.scalar_or_sequence;
    Leaf leaf{path, on_one_line(node), std::nullopt, origin_of(child)};
    if (node.IsSequence()) {
      leaf.items.emplace();
      for (const auto& item : node) leaf.items->push_back(on_one_line(item));
    }
    leaves.push_back(std::move(leaf));
  }
}

}  // namespace

const Entry* Document::Tree::Entry::find(std::string_view name) const {
  if (!places.empty()) {
    const auto found = places.find(name);
    return found == places.end() ? nullptr : &children[found->second];
  }
  for (const Entry& child : children) {
    if (child.key == name) return &child;
  }
  return nullptr;
}

void Document::Tree::Entry::add(Entry child) {
  constexpr std::size_t kFew = 16;  // are found sooner without an index
  children.push_back(std::move(child));
  if (children.size() == kFew) {
    for (std::size_t i = 0; i + 1 < children.size(); ++i) places.emplace(children[i].key, i);
  }
  if (children.size() >= kFew) places.emplace(children.back().key, children.size() - 1);
}

Entry* Document::Tree::Entry::find(std::string_view name) {
  return const_cast<Entry*>(std::as_const(*this).find(name));
}

std::string to_text(const Origin& origin) {
  return origin.line == 0 ? origin.source : origin.source + ", " + Place::line(origin.line).text;
}

Document::Document() : tree_(std::make_unique<Tree>()) { tree_->root.is_mapping = true; }
Document::Document(Document&&) noexcept = default;
Document& Document::operator=(Document&&) noexcept = default;
Document::~Document() = default;

Document Document::load(const std::filesystem::path& file) {
  return parse(files::read_text(file), file.string());
}

Document Document::parse(const std::string& yaml, const std::string& origin) {
  Document document;
  document.tree_->root = parse_mapping(yaml, origin);
  return document;
}

void Document::overlay(const Document& document) {
  overlay_entry(tree_->root, document.tree_->root);
}

void Document::set(std::string_view assignment, std::string_view option) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string_view::npos || equals == 0) {
    throw InputError(option, Place::whole_file(), "key=value", files::in_quotes(assignment));
  }
  // "a.b=1" is the YAML "a: {b: 1}": written so, it takes the same way as a file.
  std::string yaml;
  std::string closing;
  std::string_view path = assignment.substr(0, equals);
  for (std::size_t dot = path.find('.'); dot != std::string_view::npos; dot = path.find('.')) {
    yaml += "{" + std::string(path.substr(0, dot)) + ": ";
    closing += "}";
    path.remove_prefix(dot + 1);
  }
  yaml += "{" + std::string(path) + ": " + std::string(assignment.substr(equals + 1)) + "}";
  Document argument = parse(yaml + closing, std::string(option) + " " + std::string(assignment));
  forget_lines(argument.tree_->root);
  overlay(argument);
}

bool Document::has(std::string_view top_level_key) const {
  return tree_->root.find(top_level_key) != nullptr;
}

std::optional<std::string> Document::scalar(std::string_view top_level_key) const {
  const Entry* entry = tree_->root.find(top_level_key);
  if (entry == nullptr || entry->is_mapping || !entry->scalar_or_sequence.IsScalar()) {
    return std::nullopt;
  }
  return entry->scalar_or_sequence.Scalar();
}

std::optional<Origin> Document::origin(std::string_view path) const {
  const Entry* entry = &tree_->root;
  for (;;) {
    const std::size_t dot = path.find('.');
    entry = entry->find(path.substr(0, dot));
    if (entry == nullptr) return std::nullopt;
    if (dot == std::string_view::npos) break;
    path.remove_prefix(dot + 1);
  }
  return origin_of(*entry);
}

Document Document::child(std::string_view top_level_key) const {
  Document result;
  const Entry* entry = tree_->root.find(top_level_key);
  if (entry == nullptr) return result;
  if (!entry->is_mapping) {
    throw InputError(entry->origin, place_of(*entry), "a mapping under '" + entry->key + "'",
                     "a single value");
  }
  result.tree_->root = *entry;
  return result;
}

std::vector<Document> Document::items(std::string_view top_level_key,
                                      std::string_view short_key) const {
  std::vector<Document> documents;
  const Entry* entry = tree_->root.find(top_level_key);
  if (entry == nullptr) return documents;
  if (entry->is_mapping || !entry->scalar_or_sequence.IsSequence()) {
    throw InputError(entry->origin, place_of(*entry), "a list under '" + entry->key + "'",
                     entry->is_mapping ? "a mapping" : "a single value");
  }
  for (const YAML::Node& item : entry->scalar_or_sequence) {
    const int line = item.Mark().line + 1;
    const Place place = Place::line(static_cast<std::size_t>(line));
    Document document;
    if (item.IsScalar()) {
      document.tree_->root.add(build(item, std::string(short_key), entry->origin, line));
      document.tree_->root.origin = entry->origin;
      document.tree_->root.line = line;
    } else if (item.IsMap()) {
      document.tree_->root = build(item, "", entry->origin, line);
    } else {
      throw InputError(entry->origin, place, "a text or a mapping", "neither");
    }
    documents.push_back(std::move(document));
  }
  return documents;
}

std::vector<Leaf> Document::leaves() const {
  std::vector<Leaf> leaves;
  collect_leaves(tree_->root, "", leaves);
  return leaves;
}

Origin Document::origin() const { return origin_of(tree_->root); }

std::vector<std::string> Document::keys() const {
  std::vector<std::string> names;
  for (const Entry& child : tree_->root.children) names.push_back(child.key);
  return names;
}

}  // namespace traverse::config
