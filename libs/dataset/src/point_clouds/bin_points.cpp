#include "point_clouds/bin_points.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/files/binary_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/numbers.hpp"
#include "traverse/statistics/quantile.hpp"

#include "point_clouds/field_values.hpp"
#include "recording/statements.hpp"

namespace traverse::dataset {

static_assert(std::endian::native == std::endian::little, "files of points are little-endian");

using files::InputError;
using files::Place;

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLeastColumns = 3;
constexpr std::size_t kMostStatedColumns = 64;
constexpr std::array<std::string_view, 4> kFirstColumns{"x", "y", "z", "intensity"};
constexpr std::array<std::pair<std::string_view, BinType>, 4> kBinTypes{
    {{"auto", BinType::kAuto},
     {"float32", BinType::kFloat32},
     {"float64", BinType::kFloat64},
     {"nclt", BinType::kNclt}}};
// "NCLT: velodyne_sync": x y z as uint16 of 5 mm from -100 m, intensity and laser as uint8.
constexpr std::size_t kNcltBytes = 8;
constexpr float kNcltStep = 0.005F;
constexpr float kNcltLeast = -100;
constexpr std::uint8_t kNcltLasers = 32;

std::string_view name_of_type(BinType type) {
  for (const auto& [name, value] : kBinTypes) {
    if (value == type) return name;
  }
  return "unknown";
}

std::size_t bytes_of_number(BinType type) {
  return type == BinType::kFloat64 ? sizeof(double) : sizeof(float);
}

std::size_t bytes_of_point(const BinLayout& layout) {
  return layout.type == BinType::kNclt ? kNcltBytes
                                       : layout.columns.size() * bytes_of_number(layout.type);
}

std::vector<std::string> names_of_columns(std::size_t columns) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < columns; ++k) {
    names.push_back(k < kFirstColumns.size() ? std::string(kFirstColumns[k])
                                             : fmt::format("column_{}", k + 1));
  }
  return names;
}

/// A file's bytes, of which the first are looked at.
struct BinSample {
  std::vector<std::byte> bytes;
  std::size_t file_size = 0;
};

std::vector<BinSample> samples_of(const std::vector<fs::path>& files) {
  constexpr std::size_t kMostBytes =
      480'000;  // a multiple of every size of a point up to 6 numbers
  std::vector<BinSample> samples;
  for (const std::size_t i : {files.size() - 1, files.size() / 2, std::size_t{0}}) {
    BinSample sample;
    try {
      sample.bytes = files::read_bytes(files[i]);
    } catch (const InputError&) {
      continue;
    }
    sample.file_size = sample.bytes.size();
    if (sample.bytes.size() > kMostBytes) sample.bytes.resize(kMostBytes);
    if (!sample.bytes.empty()) samples.push_back(std::move(sample));
  }
  return samples;
}

template <typename Number>
std::vector<double> numbers_in(const BinSample& sample) {
  std::vector<double> numbers;
  numbers.reserve(sample.bytes.size() / sizeof(Number));
  for (std::size_t at = 0; at + sizeof(Number) <= sample.bytes.size(); at += sizeof(Number)) {
    Number number{};
    std::memcpy(&number, sample.bytes.data() + at, sizeof number);
    numbers.push_back(static_cast<double>(number));
  }
  return numbers;
}

/// The share of numbers that a lidar may have measured: metres, counts, times.
double share_of_plausible(const std::vector<double>& numbers) {
  if (numbers.empty()) return 0;
  const auto count = std::count_if(numbers.begin(), numbers.end(), [](double number) {
    const double size = std::abs(number);
    return size == 0 || std::isnan(size) || (size > 1e-9 && size < 1e19);
  });
  return static_cast<double>(count) / static_cast<double>(numbers.size());
}

/// How much numbers `columns` apart differ, as the mean over columns of the median's logarithm.
double difference_at(const std::vector<double>& numbers, std::size_t columns) {
  constexpr double kSmall = 1e-3;
  double sum = 0;
  std::vector<double> differences;
  for (std::size_t k = 0; k < columns; ++k) {
    differences.clear();
    for (std::size_t i = k; i + columns < numbers.size(); i += columns) {
      const double difference = std::abs(numbers[i + columns] - numbers[i]);
      if (std::isfinite(difference)) differences.push_back(difference);
    }
    if (differences.empty()) return std::numeric_limits<double>::infinity();
    sum += std::log(statistics::median(differences) + kSmall);
  }
  return sum / static_cast<double>(columns);
}

/// The tenths of a column's numbers that tell where they lie.
struct ColumnPlace {
  double low, middle, high;
};

ColumnPlace place_of_column(const std::vector<double>& numbers, std::size_t column,
                            std::size_t columns) {
  std::vector<double> values;
  for (std::size_t i = column; i < numbers.size(); i += columns) {
    if (std::isfinite(numbers[i])) values.push_back(numbers[i]);
  }
  if (values.empty()) return {0, 0, 0};
  return {statistics::quantile(values, 0.1), statistics::quantile(values, 0.5),
          statistics::quantile(values, 0.9)};
}

/// Whether what would be two columns lies in the same place, as the same coordinate of every other
/// point does.
bool lie_alike(const std::vector<double>& numbers, std::size_t a, std::size_t b,
               std::size_t columns) {
  constexpr double kAlike = 0.15;  // of the spread
  const ColumnPlace place_a = place_of_column(numbers, a, columns);
  const ColumnPlace place_b = place_of_column(numbers, b, columns);
  const double spread = std::max(place_a.high - place_a.low, place_b.high - place_b.low);
  return std::abs(place_a.low - place_b.low) <= kAlike * spread &&
         std::abs(place_a.middle - place_b.middle) <= kAlike * spread &&
         std::abs(place_a.high - place_b.high) <= kAlike * spread;
}

struct ColumnCount {
  std::size_t columns;
  double difference;
};

/// The count of columns that fits; nothing if none does clearly.
std::optional<std::size_t> fitting_columns(const std::vector<BinSample>& samples, BinType type,
                                           std::size_t most) {
  constexpr double kClearly = 0.3;   // of the logarithm: a third more
  constexpr double kNoWorse = 0.15;  // twice the columns fit nearly as well
  std::vector<ColumnCount> counts;
  std::vector<std::vector<double>> numbers;
  for (const BinSample& sample : samples) {
    numbers.push_back(type == BinType::kFloat64 ? numbers_in<double>(sample)
                                                : numbers_in<float>(sample));
  }
  for (std::size_t columns = kLeastColumns; columns <= most; ++columns) {
    double sum = 0;
    bool divides = true;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      divides = divides && samples[i].file_size % (columns * bytes_of_number(type)) == 0;
      sum += difference_at(numbers[i], columns);
    }
    if (divides) counts.push_back({columns, sum / static_cast<double>(samples.size())});
  }
  if (counts.empty()) return std::nullopt;
  double least = std::numeric_limits<double>::infinity();
  for (const ColumnCount& count : counts) least = std::min(least, count.difference);
  const auto best = std::find_if(counts.begin(), counts.end(), [&](const ColumnCount& count) {
    return count.difference <= least + kNoWorse;
  });
  for (const ColumnCount& other : counts) {
    const bool is_related =
        other.columns % best->columns == 0 || best->columns % other.columns == 0;
    if (!is_related && other.difference < best->difference + kClearly) return std::nullopt;
  }
  // Beams that fire in turns make every other point more alike than the next: x and y tell.
  for (const ColumnCount& part : counts) {
    const bool divides = part.columns < best->columns && best->columns % part.columns == 0;
    const bool is_alike =
        divides && std::all_of(numbers.begin(), numbers.end(), [&](const std::vector<double>& of) {
          return lie_alike(of, 0, part.columns, best->columns) &&
                 lie_alike(of, 1, part.columns + 1, best->columns);
        });
    if (is_alike) return part.columns;
  }
  return best->columns;
}

bool looks_like_nclt(const std::vector<BinSample>& samples) {
  for (const BinSample& sample : samples) {
    if (sample.file_size % kNcltBytes != 0) return false;
    for (std::size_t at = 0; at + kNcltBytes <= sample.bytes.size(); at += kNcltBytes) {
      if (std::to_integer<std::uint8_t>(sample.bytes[at + kNcltBytes - 1]) >= kNcltLasers) {
        return false;
      }
      for (std::size_t k = 0; k < 3; ++k) {
        std::uint16_t number = 0;
        std::memcpy(&number, sample.bytes.data() + at + 2 * k, sizeof number);
        const float metres = static_cast<float>(number) * kNcltStep + kNcltLeast;
        if (std::abs(metres) > 150) return false;
      }
    }
  }
  return true;
}

bool holds_whole_numbers(const std::vector<double>& numbers, std::size_t column,
                         std::size_t columns) {
  for (std::size_t i = column; i < numbers.size(); i += columns) {
    const double number = numbers[i];
    if (!(number >= 0 && number < 1024 && number == std::floor(number))) return false;
  }
  return true;
}

/// What the columns behind the first four are, by what they hold.
void name_the_others(const std::vector<BinSample>& samples, BinLayout& layout) {
  bool has_ring = false;
  bool has_time = false;
  for (std::size_t k = kFirstColumns.size(); k < layout.columns.size(); ++k) {
    const bool is_whole = std::all_of(samples.begin(), samples.end(), [&](const BinSample& sample) {
      return holds_whole_numbers(
          layout.type == BinType::kFloat64 ? numbers_in<double>(sample) : numbers_in<float>(sample),
          k, layout.columns.size());
    });
    if (is_whole && !has_ring) {
      layout.columns[k] = "ring";
      has_ring = true;
    } else if (!is_whole && !has_time) {
      layout.columns[k] = "time";
      has_time = true;
    }
  }
}

std::vector<std::string> stated_columns(const Statements& statements) {
  const std::string& stated = statements->bin.columns;
  constexpr const char* kExpected = "3 to 64 names of columns, or how many there are";
  if (const auto count = files::parse_integer(stated)) {
    if (*count < static_cast<std::int64_t>(kLeastColumns) ||
        *count > static_cast<std::int64_t>(kMostStatedColumns)) {
      throw statements.error("bin.columns", kExpected, stated);
    }
    return names_of_columns(static_cast<std::size_t>(*count));
  }
  std::vector<std::string> names;
  for (const std::string_view name : files::split_words(stated)) names.emplace_back(name);
  if (names.size() < kLeastColumns || names.size() > kMostStatedColumns) {
    throw statements.error("bin.columns", kExpected, files::in_quotes(stated));
  }
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(k), names[k]) !=
        names.begin() + static_cast<std::ptrdiff_t>(k)) {
      throw statements.error("bin.columns", "each name once", files::in_quotes(names[k]));
    }
  }
  return names;
}

std::optional<BinLayout> recognised(const std::vector<BinSample>& samples, BinType type) {
  constexpr double kNearlyAll = 0.99;
  constexpr double kTooFew = 0.9;
  if ((type == BinType::kAuto || type == BinType::kNclt) && looks_like_nclt(samples)) {
    return BinLayout{{"x", "y", "z", "intensity", "ring"}, BinType::kNclt};
  }
  if (type == BinType::kNclt) return std::nullopt;
  double singles = 1;
  double doubles = 1;
  for (const BinSample& sample : samples) {
    singles = std::min(singles, share_of_plausible(numbers_in<float>(sample)));
    doubles = std::min(doubles, share_of_plausible(numbers_in<double>(sample)));
  }
  if (type == BinType::kAuto) {
    type = singles < kTooFew && doubles > kNearlyAll ? BinType::kFloat64 : BinType::kFloat32;
  }
  constexpr std::size_t kMostColumns = 8;
  const auto columns = fitting_columns(samples, type, kMostColumns);
  if (!columns) return std::nullopt;
  BinLayout layout{names_of_columns(*columns), type};
  name_the_others(samples, layout);
  return layout;
}

template <typename Number>
void add_columns(std::span<const std::byte> bytes, const BinLayout& layout, PointCloud& cloud) {
  const std::size_t stride = layout.columns.size() * sizeof(Number);
  const std::size_t points = bytes.size() / stride;
  constexpr ScalarType kType = sizeof(Number) == 4 ? ScalarType::kFloat : ScalarType::kDouble;
  for (std::size_t k = 0; k < layout.columns.size(); ++k) {
    FieldValues values = make_values(kType, points);
    decode(values, bytes.data() + k * sizeof(Number), stride, false);
    cloud.add(layout.columns[k], std::move(values));
  }
}

void add_nclt_columns(std::span<const std::byte> bytes, PointCloud& cloud) {
  const std::size_t points = bytes.size() / kNcltBytes;
  for (std::size_t k = 0; k < 3; ++k) {
    FieldValues stored = make_values(ScalarType::kUint16, points);
    decode(stored, bytes.data() + 2 * k, kNcltBytes, false);
    std::vector<float> metres = to_floats(stored);
    for (float& value : metres) value = value * kNcltStep + kNcltLeast;
    cloud.add(std::string(kFirstColumns[k]), std::move(metres));
  }
  for (const auto& [name, offset] : {std::pair("intensity", 6), std::pair("ring", 7)}) {
    FieldValues values = make_values(ScalarType::kUint8, points);
    decode(values, bytes.data() + offset, kNcltBytes, false);
    cloud.add(name, std::move(values));
  }
}

}  // namespace

void bind(config::Binder& b, BinStatements& bin) {
  b.text("columns", bin.columns,
         "names of a point's numbers, blanks between, or how many there are; else what fits");
  b.choice("type", bin.type, kBinTypes, "of a number; auto: what fits");
}

bool BinLayout::is_kitti() const {
  return type == BinType::kFloat32 &&
         std::equal(columns.begin(), columns.end(), kFirstColumns.begin(), kFirstColumns.end());
}

BinLayout bin_layout(const std::vector<fs::path>& files, const Statements& statements,
                     std::vector<Fact>& facts) {
  BinLayout layout{names_of_columns(kFirstColumns.size()), BinType::kFloat32};
  const BinType stated_type = statements->bin.type;
  const bool columns_are_stated = !statements->bin.columns.empty();
  std::string reason = "default";
  if (columns_are_stated) {
    layout.columns = stated_columns(statements);
    if (stated_type != BinType::kAuto) layout.type = stated_type;
    if (layout.type == BinType::kNclt) layout.columns = {"x", "y", "z", "intensity", "ring"};
    reason = statements.reason("bin.columns", reason);
  } else {
    std::vector<BinSample> samples;
    if (!files.empty()) samples = samples_of(files);
    std::optional<BinLayout> found;
    if (!samples.empty()) found = recognised(samples, stated_type);
    if (found) {
      layout = *found;
      reason = "what neighbouring points have in common; else state bin.columns and bin.type";
    } else if (stated_type != BinType::kAuto) {
      layout.type = stated_type;
      if (layout.type == BinType::kNclt) layout.columns = {"x", "y", "z", "intensity", "ring"};
      reason = statements.reason("bin.type", reason);
    }
  }
  if (!layout.is_kitti() || columns_are_stated) {
    facts.push_back(
        {"bin columns",
         fmt::format("{}, {}", fmt::join(layout.columns, " "), name_of_type(layout.type)), reason});
  }
  return layout;
}

PointCloud read_bin_points(const fs::path& file, const BinLayout& layout) {
  const std::vector<std::byte> bytes = files::read_bytes(file);
  const std::size_t point_bytes = bytes_of_point(layout);
  if (bytes.size() % point_bytes != 0) {
    throw InputError(file, Place::whole_file(),
                     fmt::format("whole points of {} bytes", point_bytes),
                     fmt::format("{} bytes", bytes.size()));
  }
  PointCloud cloud;
  switch (layout.type) {
    case BinType::kNclt:
      add_nclt_columns(bytes, cloud);
      break;
    case BinType::kFloat64:
      add_columns<double>(bytes, layout, cloud);
      break;
    case BinType::kFloat32:
    case BinType::kAuto:
      add_columns<float>(bytes, layout, cloud);
      break;
  }
  return cloud;
}

}  // namespace traverse::dataset
