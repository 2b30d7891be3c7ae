#include "traverse/pipeline/frame_table.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/numbers.hpp"
#include "traverse/files/text_file.hpp"

namespace traverse::pipeline {

void FrameTable::add_row(std::vector<double> values) {
  if (values.size() != columns_.size()) {
    throw std::invalid_argument(fmt::format("a frame table row has {} values for {} columns",
                                            values.size(), columns_.size()));
  }
  rows_.push_back(std::move(values));
}

bool FrameTable::has(std::string_view column) const {
  return std::find(columns_.begin(), columns_.end(), column) != columns_.end();
}

std::vector<double> FrameTable::column(std::string_view name) const {
  const auto found = std::find(columns_.begin(), columns_.end(), name);
  if (found == columns_.end()) return {};
  const auto k = static_cast<std::size_t>(found - columns_.begin());
  std::vector<double> values;
  values.reserve(rows_.size());
  for (const auto& row : rows_) values.push_back(row[k]);
  return values;
}

void FrameTable::write_csv(const std::filesystem::path& file) const {
  files::AtomicFile target(file);
  target.stream() << fmt::format("{}\n", fmt::join(columns_, ","));
  for (const auto& row : rows_) {
    for (std::size_t k = 0; k < row.size(); ++k) {
      target.stream() << (k == 0 ? "" : ",") << files::to_text(row[k]);
    }
    target.stream() << '\n';
  }
  target.commit();
}

FrameTable FrameTable::read_csv(const std::filesystem::path& file) {
  files::LineReader reader(file);
  if (!reader.next()) throw reader.error("a header line", "an empty file");
  FrameTable table;
  for (const std::string_view name : files::split_cells(reader.line(), ',')) {
    table.columns_.emplace_back(name);
  }
  while (reader.next()) {
    std::vector<double> row;
    for (const std::string_view cell : files::split_cells(reader.line(), ',')) {
      const auto value = files::parse_double(cell);
      if (!value) throw reader.error("numbers", files::in_quotes(cell));
      row.push_back(*value);
    }
    if (row.size() != table.columns_.size()) {
      throw reader.error(fmt::format("{} values", table.columns_.size()),
                         fmt::format("{}", row.size()));
    }
    table.rows_.push_back(std::move(row));
  }
  return table;
}

}  // namespace traverse::pipeline
