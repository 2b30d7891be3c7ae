#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "definition_builder.hpp"

namespace traverse::bags {

namespace {

constexpr std::array<std::pair<std::string_view, Primitive>, 19> kIdlNames{
    {{"boolean", Primitive::kBool},
     {"octet", Primitive::kUint8},
     {"char", Primitive::kUint8},
     {"int8", Primitive::kInt8},
     {"uint8", Primitive::kUint8},
     {"short", Primitive::kInt16},
     {"int16", Primitive::kInt16},
     {"unsigned short", Primitive::kUint16},
     {"uint16", Primitive::kUint16},
     {"long", Primitive::kInt32},
     {"int32", Primitive::kInt32},
     {"unsigned long", Primitive::kUint32},
     {"uint32", Primitive::kUint32},
     {"long long", Primitive::kInt64},
     {"int64", Primitive::kInt64},
     {"unsigned long long", Primitive::kUint64},
     {"uint64", Primitive::kUint64},
     {"float", Primitive::kFloat},
     {"double", Primitive::kDouble}}};

/// The words and signs of a text, without comments and preprocessor lines.
std::vector<std::string> idl_tokens(std::string_view text) {
  constexpr std::size_t kMost = 1'000'000;
  std::vector<std::string> tokens;
  const auto is_word = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
  };
  for (std::size_t i = 0; i < text.size();) {
    if (tokens.size() > kMost) throw BadMessage("a definition of too many words");
    const bool is_line_start = i == 0 || text[i - 1] == '\n';
    if (std::isspace(static_cast<unsigned char>(text[i])) != 0) {
      ++i;
    } else if (text.substr(i).starts_with("//") ||
               (is_line_start &&
                (text[i] == '#' || text[i] == '=' || text.substr(i).starts_with("IDL:")))) {
      i = std::min(text.find('\n', i), text.size());
    } else if (text.substr(i).starts_with("/*")) {
      const auto end = text.find("*/", i + 2);
      i = end == std::string_view::npos ? text.size() : end + 2;
    } else if (text[i] == '"') {
      std::size_t end = i + 1;
      while (end < text.size() && text[end] != '"') end += text[end] == '\\' ? 2 : 1;
      tokens.emplace_back("\"");
      i = end + 1;
    } else if (text.substr(i).starts_with("::")) {
      tokens.emplace_back("::");
      i += 2;
    } else if (is_word(text[i])) {
      std::size_t end = i;
      while (end < text.size() && is_word(text[end])) ++end;
      tokens.emplace_back(text.substr(i, end - i));
      i = end;
    } else {
      tokens.emplace_back(1, text[i++]);
    }
  }
  return tokens;
}

/// Reads modules, structures, typedefs of arrays and constants; annotations are passed over.
class IdlParser {
 public:
  explicit IdlParser(std::string_view text) : tokens_(idl_tokens(text)) {}

  void parse(DefinitionBuilder& builder) {
    while (at_ < tokens_.size()) item(builder);
  }

 private:
  struct Type {
    MessageDefinition::Field field;  ///< without a name
    std::string structure;
  };

  const std::string& peek() const {
    static const std::string kNothing;
    return at_ < tokens_.size() ? tokens_[at_] : kNothing;
  }
  std::string take() {
    if (at_ >= tokens_.size()) throw BadMessage("an IDL definition that ends too early");
    return tokens_[at_++];
  }
  bool take_if(std::string_view token) {
    if (peek() != token) return false;
    ++at_;
    return true;
  }
  void expect(std::string_view token) {
    const std::string found = take();
    if (found != token) {
      throw BadMessage(
          fmt::format("an IDL definition with '{}' where '{}' should be", found, token));
    }
  }

  void skip_annotations() {
    while (take_if("@")) {
      name();
      if (!take_if("(")) continue;
      for (int depth = 1; depth > 0;) {
        const std::string token = take();
        depth += token == "(" ? 1 : token == ")" ? -1 : 0;
      }
    }
  }

  std::string name() {
    take_if("::");
    std::string text = take();
    while (take_if("::")) text += "/" + take();
    return text;
  }

  void item(DefinitionBuilder& builder) {
    skip_annotations();
    const std::string word = take();
    if (word == ";") return;
    if (word == "module") {
      modules_.push_back(take());
      if (modules_.size() > kDeepest) throw BadMessage("an IDL definition of too many modules");
      expect("{");
      while (!take_if("}")) item(builder);
      modules_.pop_back();
    } else if (word == "struct") {
      structure(builder);
    } else if (word == "typedef") {
      const Type type = type_of();
      for (const auto& [alias, declared] : declarators(type)) typedefs_[alias] = declared;
    } else if (word == "const") {
      while (take() != ";") {
      }
    } else {
      throw BadMessage(fmt::format("an IDL definition with '{}', which is not read", word));
    }
  }

  void structure(DefinitionBuilder& builder) {
    DefinitionBuilder::Written written;
    const std::string own = take();
    written.name = plain_type_name(path() + own);
    expect("{");
    while (!take_if("}")) {
      skip_annotations();
      const Type type = type_of();
      for (auto& [field_name, declared] : declarators(type)) {
        declared.field.name = field_name;
        written.fields.emplace_back(declared.field, declared.structure);
      }
    }
    builder.add(std::move(written));
  }

  std::string path() const {
    std::string text;
    for (const std::string& module : modules_) text += module + "/";
    return text;
  }

  /// "a, b[3];"
  std::vector<std::pair<std::string, Type>> declarators(const Type& type) {
    std::vector<std::pair<std::string, Type>> all;
    do {
      std::pair<std::string, Type> one(take(), type);
      while (take_if("[")) {
        if (one.second.field.count == MessageDefinition::Count::kMany) {
          throw BadMessage("an IDL definition with an array of sequences, which is not read");
        }
        const std::uint64_t before =
            one.second.field.count == MessageDefinition::Count::kFixed ? one.second.field.fixed : 1;
        one.second.field.count = MessageDefinition::Count::kFixed;
        if (__builtin_mul_overflow(before, size(), &one.second.field.fixed)) {
          throw BadMessage("an IDL definition with an array beyond all sizes");
        }
        expect("]");
      }
      all.push_back(std::move(one));
    } while (take_if(","));
    expect(";");
    return all;
  }

  std::uint64_t size() {
    const std::string text = take();
    std::uint64_t value = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (fault != std::errc() || end != text.data() + text.size()) {
      throw BadMessage(fmt::format("an IDL definition with the size '{}'", text));
    }
    return value;
  }

  Type type_of() {
    Type type;
    if (take_if("sequence")) {
      expect("<");
      type = type_of();
      if (type.field.count != MessageDefinition::Count::kOne) {
        throw BadMessage("an IDL definition with a sequence of arrays, which is not read");
      }
      type.field.count = MessageDefinition::Count::kMany;
      if (take_if(",")) take();
      expect(">");
      return type;
    }
    if (take_if("string")) {
      type.field.primitive = Primitive::kString;
      if (take_if("<")) {
        take();
        expect(">");
      }
      return type;
    }
    std::string word = name();
    if (word == "unsigned") word += " " + take();
    if ((word == "long" || word == "unsigned long") && take_if("long")) word += " long";
    for (const auto& [known, primitive] : kIdlNames) {
      if (known != word) continue;
      type.field.primitive = primitive;
      return type;
    }
    if (word == "wstring" || word == "wchar") {
      throw BadMessage("an IDL definition with wide characters, which are not read");
    }
    if (const auto alias = typedefs_.find(word.substr(word.rfind('/') + 1));
        alias != typedefs_.end()) {
      return alias->second;
    }
    type.structure = word;
    return type;
  }

  static constexpr std::size_t kDeepest = 20;
  std::vector<std::string> tokens_;
  std::size_t at_ = 0;
  std::vector<std::string> modules_;
  std::map<std::string, Type> typedefs_;
};

}  // namespace

MessageDefinition parse_idl_definition(std::string_view type, std::string_view text) {
  DefinitionBuilder builder;
  IdlParser(text).parse(builder);
  return builder.build(std::string(type));
}

}  // namespace traverse::bags
