#include "decimal_integers.hpp"

#include <string>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"
#include "traverse/files/numbers.hpp"

namespace traverse::app {

namespace {

/// Without leading zeros, and no sign where none can be: CLI11 takes -1 for the largest number.
CLI::Validator decimal(bool is_unsigned) {
  return {[is_unsigned](std::string& text) -> std::string {
            const auto number = files::parse_integer(text);
            if (!number || (is_unsigned && *number < 0)) {
              return fmt::format("expected a whole number{}, found {}",
                                 is_unsigned ? ", 0 or more" : "", files::in_quotes(text));
            }
            text = std::to_string(*number);
            return {};
          },
          ""};
}

}  // namespace

void read_integers_as_decimal(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    const std::string type = option->get_type_name();
    const bool is_unsigned = type.starts_with("UINT");
    if (is_unsigned || type.starts_with("INT")) option->transform(decimal(is_unsigned));
  }
  for (CLI::App* command : app.get_subcommands({})) read_integers_as_decimal(*command);
}

}  // namespace traverse::app
