#include "run/model.hpp"

#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace traverse::report {

void Model::add_text(const std::string& name, const std::string& text) {
  page.set(name, text);
  json[name] = text;
}

void Model::add_table(const HtmlTable& table) {
  json["tables"][table.id()] = table.json();
  page.set("table_" + table.id(), table.empty() ? TemplateData(false) : table.data());
}

Json series_number(double value) {
  if (!std::isfinite(value)) return nullptr;
  const std::string text = fmt::format("{:.9g}", value);
  double rounded = 0;
  std::from_chars(text.data(), text.data() + text.size(), rounded);
  return rounded;
}

std::string text_for_script(const Json& json) {
  const std::string plain = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string text;
  text.reserve(plain.size() + plain.size() / 64);
  for (const char c : plain) {
    switch (c) {
      case '<':
        text += "\\u003c";
        break;
      case '>':
        text += "\\u003e";
        break;
      case '&':
        text += "\\u0026";
        break;
      default:
        text += c;
    }
  }
  return text;
}

}  // namespace traverse::report
