#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "traverse/geometry/stamp.hpp"

#include "navigation_log/log_statements.hpp"
#include "recording/listed_source.hpp"
#include "recording/stamp_sequence.hpp"

namespace traverse::dataset {

/// A column's name and unit: "w_RS_S_x" and "rad s^-1" of the cell "w_RS_S_x [rad s^-1]". The '#'
/// before a header's first cell is no part of the name.
struct CsvColumn {
  std::string name;
  std::string unit;  ///< without brackets; empty: not told

  static CsvColumn of(std::string_view cell);
};

/// The rows of a CSV file that can be used, side by side: one allocation a row would outweigh its
/// numbers.
class CsvRows {
 public:
  CsvRows(std::string file, std::vector<CsvColumn> columns)
      : file_(std::move(file)), columns_(std::move(columns)) {}

  void add(geometry::Stamp stamp, std::span<const double> values, std::size_t line);
  /// Takes the stamps of `records`, one a row, and leaves out the rows that have none. `skip` is
  /// told of each what is wrong with it and where it stands.
  void take_stamps(std::span<const RecordStamp> records,
                   const std::function<void(const char* fault, const std::string& place)>& skip);

  /// As stated, in their order.
  const std::vector<CsvColumn>& columns() const { return columns_; }
  std::size_t size() const { return stamps_.size(); }
  bool empty() const { return stamps_.empty(); }
  std::vector<geometry::Stamp>& stamps() { return stamps_; }
  geometry::Stamp stamp(std::size_t i) const { return stamps_[i]; }
  std::span<const double> values(std::size_t i) const {
    return std::span(values_).subspan(i * columns_.size(), columns_.size());
  }
  Eigen::Vector3d vector(std::size_t i) const {
    const auto row = values(i);
    return {row[0], row[1], row[2]};
  }
  std::size_t line(std::size_t i) const { return lines_[i]; }
  std::string place(std::size_t i) const { return place_of_line(lines_[i]); }
  std::string place_of_line(std::size_t line) const;

 private:
  std::string file_;
  std::vector<CsvColumn> columns_;
  std::vector<geometry::Stamp> stamps_;
  std::vector<double> values_;  ///< row after row
  std::vector<std::size_t> lines_;
};

/// The names of columns that a statement lists: blanks between, or commas where names hold blanks.
std::vector<std::string_view> listed_columns(std::string_view columns);

/// Reads the columns that are stated; rows that cannot be used go to `records`. The header is the
/// first line, or the first comment line that holds the column of the time. Columns are found by
/// their names with or without '#' and unit.
/// \param time_unit_s seconds that a 1 in the time means; nothing: as the header says, else 1. What
/// the header says goes into `facts`. Times in seconds are exact to the nanosecond.
/// \param required so many columns must hold numbers; an empty cell of the others is NaN
/// \throws files::InputError if a column is missing, or most times are out of range
CsvRows read_csv_rows(const std::filesystem::path& file, const CsvColumns& stated,
                      std::optional<double> time_unit_s, std::size_t required,
                      ListedRecords& records, std::vector<Fact>& facts);

/// The statements of a file in the form of EuRoC's imu0/data.csv, by its header; nothing for
/// another file.
std::optional<CsvStatements> euroc_imu_statements(const std::filesystem::path& file);

}  // namespace traverse::dataset
