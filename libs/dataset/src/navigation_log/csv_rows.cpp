#include "navigation_log/csv_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"
#include "traverse/files/numbers.hpp"
#include "traverse/files/text_file.hpp"

namespace traverse::dataset {

using files::LineReader;
using geometry::Stamp;

namespace {

constexpr double kLatestTime_s = 9e9;  // seconds that whole nanoseconds can hold

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::string_view without_quotes(std::string_view cell) {
  const bool is_quoted = cell.size() >= 2 && cell.front() == '"' && cell.back() == '"';
  return is_quoted ? cell.substr(1, cell.size() - 2) : cell;
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells = files::split_cells(line, ',');
  for (std::string_view& cell : cells) cell = without_quotes(cell);
  return cells;
}

/// A header and where the columns stand in it.
class CsvHeader {
 public:
  explicit CsvHeader(std::string_view line) {
    for (const auto cell : cells_of(line)) columns_.push_back(CsvColumn::of(cell));
  }
  std::size_t size() const { return columns_.size(); }
  const CsvColumn& operator[](std::size_t i) const { return columns_[i]; }

  std::optional<std::size_t> find(std::string_view name) const {
    const CsvColumn wanted = CsvColumn::of(name);
    const auto found = std::find_if(columns_.begin(), columns_.end(), [&](const CsvColumn& column) {
      return column.name == wanted.name && (wanted.unit.empty() || column.unit == wanted.unit);
    });
    if (found == columns_.end()) return std::nullopt;
    return static_cast<std::size_t>(found - columns_.begin());
  }

 private:
  std::vector<CsvColumn> columns_;
};

bool is_comment(std::string_view line) { return without_blanks(line).starts_with('#'); }

/// Advances to the header; nothing for a file without lines.
std::optional<CsvHeader> read_header(LineReader& reader, std::string_view time) {
  while (reader.next(LineReader::Comments::kGive)) {
    CsvHeader header(reader.line());
    const bool is_header = header.size() > 1 && header.find(time);
    if (is_header || !is_comment(reader.line())) return header;
  }
  return std::nullopt;
}

/// Seconds that a 1 means in a column of that unit.
std::optional<double> seconds_in(std::string_view unit) {
  constexpr std::array<std::pair<std::string_view, double>, 8> kUnits{{{"s", 1},
                                                                       {"sec", 1},
                                                                       {"ms", 1e-3},
                                                                       {"msec", 1e-3},
                                                                       {"us", 1e-6},
                                                                       {"usec", 1e-6},
                                                                       {"ns", 1e-9},
                                                                       {"nsec", 1e-9}}};
  for (const auto& [name, seconds] : kUnits) {
    if (unit == name) return seconds;
  }
  return std::nullopt;
}

/// What is known of times that are out of range.
struct TimesOutOfRange {
  std::size_t count = 0;
  std::size_t first_line = 0;
  std::string first;
};

}  // namespace

CsvColumn CsvColumn::of(std::string_view cell) {
  cell = without_blanks(cell);
  while (cell.starts_with('#')) cell = without_blanks(cell.substr(1));
  const std::size_t bracket = cell.find_last_of("[(");
  if (bracket == std::string_view::npos || bracket == 0 || cell.find_last_of("])") < bracket) {
    return {std::string(cell), {}};
  }
  const std::string_view unit = cell.substr(bracket + 1, cell.find_last_of("])") - bracket - 1);
  return {std::string(without_blanks(cell.substr(0, bracket))), std::string(without_blanks(unit))};
}

void CsvRows::add(Stamp stamp, std::span<const double> values, std::size_t line) {
  stamps_.push_back(stamp);
  values_.insert(values_.end(), values.begin(), values.end());
  lines_.push_back(line);
}

void CsvRows::take_stamps(
    std::span<const RecordStamp> records,
    const std::function<void(const char* fault, const std::string& place)>& skip) {
  const std::size_t width = columns_.size();
  std::size_t end = 0;
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (!records[i].stamp) {
      skip(records[i].fault, place(i));
      continue;
    }
    stamps_[end] = *records[i].stamp;
    lines_[end] = lines_[i];
    const auto row = values_.begin() + static_cast<std::ptrdiff_t>(i * width);
    std::copy(row, row + static_cast<std::ptrdiff_t>(width),
              values_.begin() + static_cast<std::ptrdiff_t>(end * width));
    ++end;
  }
  stamps_.resize(end);
  lines_.resize(end);
  values_.resize(end * width);
}

std::string CsvRows::place_of_line(std::size_t line) const {
  return fmt::format("{}, line {}", file_, line);
}

std::vector<std::string_view> listed_columns(std::string_view columns) {
  if (columns.find(',') == std::string_view::npos) return files::split_words(columns);
  return files::split_cells(columns, ',');
}

CsvRows read_csv_rows(const std::filesystem::path& file, const CsvColumns& stated,
                      std::optional<double> time_unit_s, std::size_t required,
                      ListedRecords& records, std::vector<Fact>& facts) {
  LineReader reader(file);
  const auto header = read_header(reader, stated.time);
  if (!header) throw reader.error("a header line", "an empty file");
  const auto column_of = [&](std::string_view name) {
    const auto found = header->find(name);
    if (!found) {
      constexpr std::size_t kShown = 500;
      throw reader.error("a column " + files::in_quotes(name), reader.line().substr(0, kShown));
    }
    return *found;
  };
  std::vector<std::size_t> columns{column_of(stated.time)};
  std::vector<CsvColumn> names;
  for (const auto name : listed_columns(stated.columns)) {
    columns.push_back(column_of(name));
    names.push_back((*header)[columns.back()]);
  }
  const CsvColumn& time = (*header)[columns.front()];
  const auto told_s = seconds_in(time.unit);
  if (!time_unit_s && told_s) {
    facts.push_back({file.filename().string() + ", unit of the time", time.unit,
                     "the header's '" + time.name + " [" + time.unit + "]'"});
  }
  const double unit_s = time_unit_s.value_or(told_s.value_or(1));

  CsvRows rows(file.filename().string(), std::move(names));
  TimesOutOfRange out_of_range;
  std::vector<double> values;
  while (reader.next()) {
    const auto cells = cells_of(reader.line());
    std::string fault;
    Stamp stamp;
    values.clear();
    if (cells.size() != header->size())
      fault = "CSV line with another number of cells than its header";
    for (std::size_t k = 0; k < columns.size() && fault.empty(); ++k) {
      const std::string_view cell = cells[columns[k]];
      if (k > required && without_blanks(cell).empty()) {
        values.push_back(std::numeric_limits<double>::quiet_NaN());
        continue;
      }
      const auto value = files::parse_double(cell);
      if (!value || !std::isfinite(*value)) fault = "CSV line with a cell that is no finite number";
      if (fault.empty() && k == 0) {
        const double seconds = *value * unit_s;
        if (!(std::abs(seconds) <= kLatestTime_s)) {
          fault = "CSV line with no such time";
          if (out_of_range.count++ == 0) {
            out_of_range.first_line = reader.number();
            out_of_range.first = cells[columns[k]];
          }
        }
        const auto exact = unit_s == 1 ? geometry::parse_stamp_seconds(cell) : std::nullopt;
        stamp = exact.value_or(Stamp::from_seconds(seconds));
      }
      if (fault.empty() && k > 0) values.push_back(*value);
    }
    if (fault.empty()) {
      rows.add(stamp, values, reader.number());
    } else {
      records.skip(fault, rows.place_of_line(reader.number()));
    }
  }
  if (out_of_range.count > rows.size()) {
    throw files::InputError(file, files::Place::line(out_of_range.first_line),
                            fmt::format("a time in seconds, since csv.time_unit_s is {}", unit_s),
                            time_out_of_range(out_of_range.first, "csv.time_unit_s"));
  }
  return rows;
}

std::optional<CsvStatements> euroc_imu_statements(const std::filesystem::path& file) {
  constexpr const char* kTime = "timestamp";
  constexpr std::array<const char*, 6> kNames{"w_RS_S_x", "w_RS_S_y", "w_RS_S_z",
                                              "a_RS_S_x", "a_RS_S_y", "a_RS_S_z"};
  LineReader reader(file);
  const auto header = read_header(reader, kTime);
  if (!header || !header->find(kTime)) return std::nullopt;
  for (const char* name : kNames) {
    if (!header->find(name)) return std::nullopt;
  }
  CsvStatements statements;
  const std::string name = file.filename().string();
  statements.gyro = {name, kTime, fmt::format("{} {} {}", kNames[0], kNames[1], kNames[2]), 0};
  statements.accelerometer = {name, kTime, fmt::format("{} {} {}", kNames[3], kNames[4], kNames[5]),
                              0};
  return statements;
}

}  // namespace traverse::dataset
