#include "recording/stamp_files.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"
#include "traverse/files/numbers.hpp"
#include "traverse/files/text_file.hpp"

namespace traverse::dataset {

using geometry::Stamp;

namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
constexpr const char* kSeconds = "seconds";
constexpr const char* kDates = "dates and times of day, UTC";

std::string_view trimmed(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t first = line.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return line.substr(first, line.find_last_not_of(kBlanks) - first + 1);
}

std::optional<unsigned> digits(std::string_view text, std::size_t begin, std::size_t count) {
  if (begin + count > text.size()) return std::nullopt;
  const auto number = files::parse_integer(text.substr(begin, count));
  if (!number || *number < 0) return std::nullopt;
  return static_cast<unsigned>(*number);
}

/// "YYYY-MM-DD hh:mm:ss", then decimals of the second.
std::optional<Stamp> parse_date_and_time(std::string_view text) {
  constexpr std::string_view kForm = "YYYY-MM-DD hh:mm:ss";
  if (text.size() < kForm.size()) return std::nullopt;
  for (const std::size_t i : {4U, 7U, 10U, 13U, 16U}) {
    if (text[i] != kForm[i] && !(i == 10 && text[i] == 'T')) return std::nullopt;
  }
  const auto year = digits(text, 0, 4);
  const auto month = digits(text, 5, 2);
  const auto day = digits(text, 8, 2);
  const auto hour = digits(text, 11, 2);
  const auto minute = digits(text, 14, 2);
  const auto second = geometry::parse_stamp_seconds(text.substr(17));
  if (!year || !month || !day || !hour || !minute || !second) return std::nullopt;

  const std::chrono::year_month_day date(std::chrono::year(static_cast<int>(*year)),
                                         std::chrono::month(*month), std::chrono::day(*day));
  const bool in_range = date.ok() && *hour < 24 && *minute < 60 && second->nanoseconds >= 0 &&
                        second->nanoseconds <= 60 * kNanosecondsPerSecond;
  if (!in_range) return std::nullopt;
  const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  const std::int64_t minutes = (days * 24 + *hour) * 60 + *minute;
  return Stamp{minutes * 60 * kNanosecondsPerSecond + second->nanoseconds};
}

}  // namespace

std::optional<StampText> parse_stamp(std::string_view text) {
  if (const auto seconds = geometry::parse_stamp_seconds(text))
    return StampText{*seconds, kSeconds};
  if (const auto moment = parse_date_and_time(text)) {
    return StampText{*moment, kDates};
  }
  const auto number = files::parse_double(text);
  const auto unit = number ? geometry::unix_time_unit(*number) : std::nullopt;
  const auto stamp = unit ? geometry::parse_unix_time(text, *unit) : std::nullopt;
  if (!stamp) return std::nullopt;
  return StampText{*stamp, std::string(name_of(*unit)) + ", told by their size"};
}

std::string name_with_form(const StampFile& file) {
  const std::string name = file.file.filename().string();
  const bool is_usual = file.form.empty() || file.form == kSeconds || file.form == kDates;
  return is_usual ? name : fmt::format("{} ({})", name, file.form);
}

StampFile read_stamps(const std::filesystem::path& file) {
  // A line may be a single byte, but what is made of its stamp takes a hundred.
  constexpr std::size_t kMostStamps = std::size_t{1} << 20;  // more than a day at 10 Hz
  StampFile result;
  result.file = file;
  auto& stamps = result.stamps;
  const std::string text = files::read_text(file);
  std::size_t blank_lines = 0;  // since the last stamp
  std::size_t number = 0;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = trimmed(std::string_view(text).substr(begin, end - begin));
    begin = end + 1;
    ++number;
    if (line.starts_with('#')) continue;
    if (line.empty()) {
      ++blank_lines;
      continue;
    }
    if (stamps.size() + blank_lines >= kMostStamps) {
      throw files::InputError(file, files::Place::line(number),
                              fmt::format("at most {} stamps", kMostStamps), "more");
    }
    stamps.resize(stamps.size() + std::exchange(blank_lines, 0));
    const auto parsed = parse_stamp(line);
    stamps.push_back(parsed ? std::optional(parsed->stamp) : std::nullopt);
    if (parsed && result.form.empty()) result.form = parsed->form;
  }
  return result;
}

}  // namespace traverse::dataset
