#include "page/exports.hpp"

#include <fmt/format.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/csv.hpp"
#include "traverse/files/latex.hpp"

#include "page/number_text.hpp"

namespace traverse::report {

namespace {

std::string csv_cell(const Json& value) {
  if (value.is_null()) return {};
  return value.is_string() ? files::csv_cell(value.get<std::string>()) : value.dump();
}

std::string latex_cell(const Json& value) {
  if (value.is_null()) return "--";
  if (value.is_number_integer()) return value.dump();
  if (value.is_string()) return files::latex_text(value.get<std::string>());
  std::string number = short_number(value);
  constexpr std::string_view kTrueMinus = "\u2212";
  if (number.starts_with(kTrueMinus)) number = "$-$" + number.substr(kTrueMinus.size());
  return number;
}

bool numeric_column(const Json& table, std::size_t column) {
  const Json& rows = table.at("rows");
  return !rows.empty() && rows.front().at(column).is_number();
}

template <typename Cell>
std::string joined(const Json& cells, const char* separator, Cell cell) {
  std::string line;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    if (k > 0) line += separator;
    line += cell(cells[k]);
  }
  return line;
}

}  // namespace

std::string to_csv(const Json& table) {
  std::string text = joined(table.at("columns"), ",", csv_cell) + "\r\n";
  for (const Json& row : table.at("rows")) text += joined(row, ",", csv_cell) + "\r\n";
  return text;
}

std::string to_latex(const Json& table) {
  std::string columns;
  for (std::size_t k = 0; k < table.at("columns").size(); ++k) {
    columns += numeric_column(table, k) ? 'r' : 'l';
  }
  std::string text = fmt::format(
      "% {}; needs \\usepackage{{booktabs}}\n\\begin{{tabular}}{{{}}}\n"
      "\\toprule\n",
      table.at("title").get<std::string>(), columns);
  text += joined(table.at("columns"), " & ", latex_cell) + " \\\\\n\\midrule\n";
  for (const Json& row : table.at("rows")) text += joined(row, " & ", latex_cell) + " \\\\\n";
  return text + "\\bottomrule\n\\end{tabular}\n";
}

void export_tables(const Json& tables, const std::filesystem::path& folder) {
  files::make_writable_folder(folder);
  for (const auto& [id, table] : tables.items()) {
    files::write_text(folder / (id + ".csv"), to_csv(table));
    files::write_text(folder / (id + ".tex"), to_latex(table));
  }
}

}  // namespace traverse::report
