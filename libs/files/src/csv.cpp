#include "traverse/files/csv.hpp"

#include "traverse/files/numbers.hpp"

namespace traverse::files {

namespace {

constexpr std::string_view kBeginsFormula = "=+-@\t\r\n";
constexpr std::string_view kNeedsQuotes = ",\"\r\n";

bool is_formula(std::string_view text) {
  return !text.empty() && kBeginsFormula.find(text.front()) != std::string_view::npos &&
         !parse_double(text);
}

}  // namespace

std::string csv_cell(std::string_view text) {
  const bool formula = is_formula(text);
  if (!formula && text.find_first_of(kNeedsQuotes) == std::string_view::npos) {
    return std::string(text);
  }
  std::string cell = formula ? "\"'" : "\"";
  for (const char c : text) {
    if (c == '"') cell += '"';
    cell += c;
  }
  return cell + '"';
}

}  // namespace traverse::files
