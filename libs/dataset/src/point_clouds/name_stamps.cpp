#include "point_clouds/name_stamps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "traverse/files/numbers.hpp"
#include "traverse/statistics/quantile.hpp"

#include "recording/stamp_files.hpp"

namespace traverse::dataset {

using geometry::Stamp;

namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

bool is_a_digit(char c) { return c >= '0' && c <= '9'; }

/// Takes the digits off the end of `text`.
std::string_view take_last_digits(std::string_view& text) {
  std::size_t begin = text.size();
  while (begin > 0 && is_a_digit(text[begin - 1])) --begin;
  const std::string_view digits = text.substr(begin);
  text.remove_suffix(digits.size());
  return digits;
}

std::int64_t number_of(std::string_view digits) { return files::parse_integer(digits).value_or(0); }

/// The digits with which a name ends, and what is right before them.
struct NameEnd {
  std::string_view seconds;   ///< or the whole number
  char separator = 0;         ///< between the two; 0: there is one number
  std::string_view fraction;  ///< digits behind the separator
  std::string_view before;
};

NameEnd end_of(std::string_view name) {
  NameEnd end;
  end.seconds = take_last_digits(name);
  if (!name.empty() && (name.back() == '.' || name.back() == '_' || name.back() == '-')) {
    std::string_view rest = name;
    rest.remove_suffix(1);
    const std::string_view before = take_last_digits(rest);
    if (!before.empty()) {
      end.separator = name.back();
      end.fraction = end.seconds;
      end.seconds = before;
      name = rest;
    }
  }
  end.before = name;
  return end;
}

bool is_unix_seconds(std::string_view digits) {
  return digits.size() == 10 || (digits.size() == 9 && digits.front() != '0');
}

std::int64_t as_decimals(std::string_view digits) {
  std::int64_t nanoseconds = 0;
  for (std::size_t k = 0; k < 9; ++k) {
    nanoseconds = 10 * nanoseconds + (k < digits.size() ? digits[k] - '0' : 0);
  }
  return nanoseconds;
}

std::vector<double> intervals_between(std::vector<Stamp> stamps) {
  std::sort(stamps.begin(), stamps.end());
  std::vector<double> intervals;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    intervals.push_back(geometry::seconds_between(stamps[i - 1], stamps[i]));
  }
  return intervals;
}

/// How far the intervals are from their median, together.
double irregularity(const std::vector<Stamp>& stamps) {
  const std::vector<double> intervals = intervals_between(stamps);
  if (intervals.empty()) return 0;
  const double median = statistics::median(intervals);
  double sum = 0;
  for (const double interval : intervals) sum += std::abs(interval - median);
  return sum;
}

/// Seconds and what follows them, as decimals or as a count of nanoseconds.
std::optional<NameStamps> seconds_and_more(const std::vector<NameEnd>& ends) {
  NameStamps decimals{{}, "seconds"};
  NameStamps counts{{}, "seconds and nanoseconds"};
  bool is_filled_up = true;  // all of one length: decimals and count of 9 digits are the same
  bool may_be_count = true;
  for (const NameEnd& end : ends) {
    const bool may_be_seconds =
        is_unix_seconds(end.seconds) || (end.fraction.size() == 9 && end.seconds.size() < 9);
    if (!may_be_seconds || end.fraction.size() > 9) return std::nullopt;
    const std::int64_t seconds = number_of(end.seconds) * kSecond;
    decimals.stamps.push_back({seconds + as_decimals(end.fraction)});
    counts.stamps.push_back({seconds + number_of(end.fraction)});
    is_filled_up = is_filled_up && end.fraction.size() == ends.front().fraction.size();
    may_be_count = may_be_count && (end.fraction.size() == 1 || end.fraction.front() != '0');
  }
  const bool has_point = ends.front().separator == '.';
  if (is_filled_up) {
    if (!has_point && ends.front().fraction.size() == 9) decimals.form = counts.form;
    return decimals;
  }
  if (has_point && !may_be_count) return decimals;
  return irregularity(counts.stamps) < irregularity(decimals.stamps) ? counts : decimals;
}

std::optional<NameStamps> whole_numbers(const std::vector<NameEnd>& ends) {
  constexpr std::array<std::pair<std::size_t, geometry::UnixTimeUnit>, 3> kDigits{
      {{13, geometry::UnixTimeUnit::kMilliseconds},
       {16, geometry::UnixTimeUnit::kMicroseconds},
       {19, geometry::UnixTimeUnit::kNanoseconds}}};
  for (const auto& [digits, unit] : kDigits) {
    NameStamps found{{}, std::string(name_of(unit))};
    for (const NameEnd& end : ends) {
      const std::string_view number = end.separator == 0 ? end.seconds : end.fraction;
      const auto stamp =
          number.size() == digits ? geometry::parse_unix_time(number, unit) : std::nullopt;
      if (!stamp) break;
      found.stamps.push_back(*stamp);
    }
    if (found.stamps.size() == ends.size()) return found;
  }
  return std::nullopt;
}

/// Days from 1970-01-01, by Hinnant, "chrono-compatible low-level date algorithms".
std::int64_t days_from_civil(std::int64_t year, std::int64_t month, std::int64_t day) {
  year -= month <= 2 ? 1 : 0;
  const std::int64_t era = year / 400;
  const std::int64_t year_of_era = year - era * 400;
  const std::int64_t day_of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  return era * 146097 + year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year -
         719468;
}

/// "...20240102T030405.678901", "...20240102_030405"
std::optional<Stamp> date_in(std::string_view name) {
  std::string_view fraction;
  std::string_view rest = name;
  const std::string_view last = take_last_digits(rest);
  if (!last.empty() && last.size() <= 9 && rest.ends_with('.')) {
    fraction = last;
    name = rest.substr(0, rest.size() - 1);
  }
  const std::string_view time = take_last_digits(name);
  if (time.size() != 6 || name.empty()) return std::nullopt;
  if (name.back() != 'T' && name.back() != '_' && name.back() != '-') return std::nullopt;
  name.remove_suffix(1);
  const std::string_view date = take_last_digits(name);
  if (date.size() != 8) return std::nullopt;
  const std::int64_t month = number_of(date.substr(4, 2));
  const std::int64_t day = number_of(date.substr(6, 2));
  const std::int64_t hours = number_of(time.substr(0, 2));
  const std::int64_t minutes = number_of(time.substr(2, 2));
  const std::int64_t seconds = number_of(time.substr(4, 2));
  if (month < 1 || month > 12 || day < 1 || day > 31 || hours > 23 || minutes > 59 ||
      seconds > 60) {
    return std::nullopt;
  }
  const std::int64_t days = days_from_civil(number_of(date.substr(0, 4)), month, day);
  const std::int64_t whole = ((days * 24 + hours) * 60 + minutes) * 60 + seconds;
  return Stamp{whole * kSecond + as_decimals(fraction)};
}

std::optional<NameStamps> dates(const std::vector<std::string>& names) {
  NameStamps found{{}, "date and time of day, UTC"};
  for (const std::string& name : names) {
    const auto stamp = date_in(name);
    if (!stamp) return std::nullopt;
    found.stamps.push_back(*stamp);
  }
  std::vector<Stamp> sorted = found.stamps;  // several in one second: the date of a drive, say
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) return std::nullopt;
  return found;
}

/// Whole names that are decimal numbers.
std::optional<NameStamps> decimal_numbers(const std::vector<std::string>& names) {
  NameStamps found;
  for (const std::string& name : names) {
    if (name.find('.') == std::string::npos) return std::nullopt;
    const auto stamp = parse_stamp(name);
    if (!stamp) return std::nullopt;
    if (found.form.empty()) found.form = stamp->form;
    found.stamps.push_back(stamp->stamp);
  }
  return found;
}

}  // namespace

std::optional<NameStamps> stamps_in_names(const std::vector<std::string>& names) {
  if (names.empty()) return std::nullopt;
  if (auto found = dates(names)) return found;
  std::vector<NameEnd> ends;
  for (const std::string& name : names) {
    const NameEnd end = end_of(name);
    if (end.seconds.empty()) return std::nullopt;
    ends.push_back(end);
  }
  const bool is_one_form = std::all_of(ends.begin(), ends.end(), [&](const NameEnd& end) {
    return end.separator == ends.front().separator;
  });
  if (is_one_form && ends.front().separator != 0) {
    auto found = seconds_and_more(ends);
    // A time and a number that counts the scans of it are no stamps.
    constexpr double kLeastInterval = 1e-3;
    const auto intervals = found ? intervals_between(found->stamps) : std::vector<double>{};
    if (found && (intervals.empty() || statistics::median(intervals) > kLeastInterval)) {
      return found;
    }
  }
  if (auto found = whole_numbers(ends)) return found;
  return decimal_numbers(names);
}

}  // namespace traverse::dataset
