#include "point_clouds/scan_files.hpp"

#include <algorithm>
#include <cctype>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "traverse/files/numbers.hpp"

namespace traverse::dataset {

namespace {

namespace fs = std::filesystem;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Takes the digits at the front of `text`, without leading zeros.
std::string_view take_digits(std::string_view& text) {
  std::size_t end = 0;
  while (end < text.size() && is_digit(text[end])) ++end;
  std::string_view digits = text.substr(0, end);
  text.remove_prefix(end);
  while (digits.size() > 1 && digits.front() == '0') digits.remove_prefix(1);
  return digits;
}

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// The numbers that the files are named by, if every one is and each has a line.
std::optional<std::vector<std::size_t>> line_numbers(const std::vector<fs::path>& scans,
                                                     std::size_t lines) {
  std::vector<std::size_t> numbers;
  for (const fs::path& scan : scans) {
    const auto number = files::parse_integer(scan.stem().string());
    if (!number || *number < 0 || static_cast<std::size_t>(*number) >= lines) return std::nullopt;
    numbers.push_back(static_cast<std::size_t>(*number));
  }
  return numbers;
}

}  // namespace

bool naturally_before(std::string_view a, std::string_view b) {
  const std::string_view whole_a = a;
  const std::string_view whole_b = b;
  while (!a.empty() && !b.empty()) {
    if (is_digit(a.front()) && is_digit(b.front())) {
      const std::string_view number_a = take_digits(a);
      const std::string_view number_b = take_digits(b);
      if (number_a.size() != number_b.size()) return number_a.size() < number_b.size();
      if (number_a != number_b) return number_a < number_b;
    } else {
      if (a.front() != b.front()) return a.front() < b.front();
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
  }
  if (a.empty() != b.empty()) return a.empty();
  return whole_a < whole_b;  // "01" and "1": any order, but always the same
}

std::vector<fs::path> files_with_extension(const fs::path& folder, std::string_view extension) {
  std::vector<fs::path> found;
  if (!fs::is_directory(folder)) return found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file() && lower_case(entry.path().extension().string()) == extension) {
      found.push_back(entry.path());
    }
  }
  std::sort(found.begin(), found.end(), [](const fs::path& a, const fs::path& b) {
    return naturally_before(a.filename().string(), b.filename().string());
  });
  return found;
}

SensorStamps sensor_stamps(const StampFile& times, const std::string& what) {
  return {what, StampSequence::of(times.stamps), [&times](std::size_t record) {
            return fmt::format("{}, stamp {}", times.file.filename().string(), record + 1);
          }};
}

std::vector<RecordStamp> settled_stamps(const StampFile& times, const std::string& what,
                                        std::vector<Fact>& facts) {
  SensorStamps sensor = sensor_stamps(times, what);
  settle_steps(std::span(&sensor, 1), facts);
  return std::move(sensor.sequence.records);
}

std::vector<ScanFile> stamp_by_line(const std::vector<fs::path>& files,
                                    const std::vector<RecordStamp>& stamps,
                                    const std::string& times_name, const std::string& what,
                                    std::vector<Fact>& facts) {
  const auto numbers = line_numbers(files, stamps.size());
  std::vector<ScanFile> stamped;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::size_t line = numbers ? (*numbers)[i] : i;
    ScanFile file{files[i], std::nullopt};
    if (line < stamps.size()) file = {files[i], stamps[line].stamp, stamps[line].fault};
    stamped.push_back(std::move(file));
  }
  facts.push_back({what + " stamps", times_name,
                   numbers ? "line N+1 for the file with number N" : "a line a file, in order"});
  if (stamps.size() != files.size()) {
    facts.push_back({what + " stamps do not match",
                     fmt::format("{} stamps for {} files", stamps.size(), files.size()),
                     stamps.size() > files.size()
                         ? "surplus lines of " + times_name + " are not used"
                         : "files without a line are skipped"});
  }
  return stamped;
}

std::vector<ScanFile> stamp_by_period(const std::vector<fs::path>& scans,
                                      const Statements& statements, std::vector<Fact>& facts) {
  geometry::Stamp first;
  if (statements.states("first_stamp")) {
    const auto stated = geometry::parse_stamp_seconds(statements->first_stamp);
    if (!stated) {
      throw statements.error("first_stamp", "seconds", files::in_quotes(statements->first_stamp));
    }
    first = *stated;
  }
  std::vector<ScanFile> stamped;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    stamped.push_back({scans[i], shifted(first, static_cast<double>(i) * statements->period_s)});
  }
  facts.push_back({"scan stamps",
                   fmt::format("{} s, then every {} s", to_text(first), statements->period_s),
                   statements.reason("period_s", "no times file; period_s is not stated")});
  return stamped;
}

std::vector<std::optional<geometry::Stamp>> stamps_of(const std::vector<RecordStamp>& records) {
  std::vector<std::optional<geometry::Stamp>> stamps;
  stamps.reserve(records.size());
  for (const RecordStamp& record : records) stamps.push_back(record.stamp);
  return stamps;
}

std::vector<std::optional<geometry::Stamp>> stamps_of(const std::vector<ScanFile>& scans) {
  std::vector<std::optional<geometry::Stamp>> stamps;
  stamps.reserve(scans.size());
  for (const ScanFile& scan : scans) stamps.push_back(scan.stamp);
  return stamps;
}

}  // namespace traverse::dataset
