#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/csv.hpp"
#include "traverse/files/latex.hpp"
#include "traverse/files/numbers.hpp"
#include "traverse/page/table.hpp"

namespace traverse::page {

namespace {

std::string csv_of(const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell.value)) return files::csv_cell(*text);
  if (const auto* number = std::get_if<double>(&cell.value)) return files::to_text(*number);
  if (const auto* count = std::get_if<std::size_t>(&cell.value)) return std::to_string(*count);
  return {};
}

void replace(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

std::string latex_of(const Cell& cell) {
  std::string text = cell.numeric ? cell.text : files::latex_text(cell.text);
  if (cell.numeric) {
    replace(text, "\u2009", "");
    replace(text, "\u2212", "$-$");
    replace(text, "\u2013", "--");
    replace(text, "±", "$\\pm$");
  }
  return cell.best ? "\\textbf{" + text + "}" : text;
}

std::string markdown_text(std::string text) {
  replace(text, "|", "\\|");
  replace(text, "\n", " ");
  return text;
}

/// Numbers in plain characters: they are copied from documents.
std::string markdown_of(const Cell& cell) {
  std::string text = markdown_text(cell.text);
  if (cell.numeric) {
    replace(text, "\u2009", "");
    replace(text, "\u2212", "-");
    replace(text, "\u2013", "-");
  }
  return cell.best ? "**" + text + "**" : text;
}

/// Characters that a terminal shows: bytes of UTF-8 that do not continue another.
std::size_t shown_width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

template <typename Items, typename Text>
std::string joined(const Items& items, const char* separator, Text text) {
  std::string line;
  for (std::size_t k = 0; k < items.size(); ++k) {
    if (k > 0) line += separator;
    line += text(items[k]);
  }
  return line;
}

}  // namespace

std::string to_csv(const Table& table) {
  std::string text = joined(table.columns(), ",", files::csv_cell) + "\r\n";
  for (const Table::Row& row : table.rows()) text += joined(row.cells, ",", csv_of) + "\r\n";
  return text;
}

std::string to_latex(const Table& table) {
  std::string columns;
  for (std::size_t k = 0; k < table.columns().size(); ++k) {
    columns += table.is_numeric(k) ? 'r' : 'l';
  }
  std::string text = fmt::format(
      "% {}; needs \\usepackage{{booktabs}}\n\\begin{{tabular}}{{{}}}\n"
      "\\toprule\n",
      table.title(), columns);
  text += joined(table.columns(), " & ", files::latex_text) + " \\\\\n\\midrule\n";
  for (const Table::Row& row : table.rows()) text += joined(row.cells, " & ", latex_of) + " \\\\\n";
  return text + "\\bottomrule\n\\end{tabular}\n";
}

std::string to_markdown(const Table& table) {
  std::string text = "| " + joined(table.columns(), " | ", markdown_text) + " |\n|";
  for (std::size_t k = 0; k < table.columns().size(); ++k) text += "---|";
  text += "\n";
  for (const Table::Row& row : table.rows()) {
    text += "| " + joined(row.cells, " | ", markdown_of) + " |\n";
  }
  return text;
}

std::string to_text(const Table& table) {
  std::vector<std::vector<std::string>> lines{table.columns()};
  for (const Table::Row& row : table.rows()) {
    auto& line = lines.emplace_back();
    for (const Cell& cell : row.cells) line.push_back(cell.text);
  }
  std::vector<std::size_t> widths(table.columns().size(), 0);
  for (const auto& line : lines) {
    for (std::size_t k = 0; k < line.size(); ++k) {
      widths[k] = std::max(widths[k], shown_width(line[k]));
    }
  }
  std::string text = table.title() + "\n";
  for (const auto& line : lines) {
    std::string row = " ";
    for (std::size_t k = 0; k < line.size(); ++k) {
      const std::string padding(widths[k] - shown_width(line[k]), ' ');
      row += " " + (table.is_numeric(k) ? padding + line[k] : line[k] + padding) + " ";
    }
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + "\n";
  }
  return text;
}

void export_tables(const std::vector<Table>& tables, const std::filesystem::path& folder) {
  files::make_writable_folder(folder);
  for (const Table& table : tables) {
    files::write_text(folder / (table.id() + ".csv"), to_csv(table));
    files::write_text(folder / (table.id() + ".tex"), to_latex(table));
  }
}

}  // namespace traverse::page
