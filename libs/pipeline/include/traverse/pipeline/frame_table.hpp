#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace traverse::pipeline {

/// frames.csv: one row a frame, named columns of numbers.
class FrameTable {
 public:
  FrameTable() = default;
  explicit FrameTable(std::vector<std::string> columns) : columns_(std::move(columns)) {}

  /// \throws std::invalid_argument unless there is one value a column.
  void add_row(std::vector<double> values);

  const std::vector<std::string>& columns() const { return columns_; }
  const std::vector<std::vector<double>>& rows() const { return rows_; }

  bool has(std::string_view column) const;
  /// All values of a column; empty if there is no such column.
  std::vector<double> column(std::string_view name) const;

  /// \throws files::OutputError
  void write_csv(const std::filesystem::path& file) const;
  /// \throws files::InputError naming the line.
  static FrameTable read_csv(const std::filesystem::path& file);

 private:
  std::vector<std::string> columns_;
  std::vector<std::vector<double>> rows_;
};

}  // namespace traverse::pipeline
