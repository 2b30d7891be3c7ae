#include "point_clouds/field_values.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace traverse::dataset {

namespace {

template <typename Number, bool swap_bytes>
void decode_all(std::vector<Number>& values, const std::byte* first, std::size_t stride) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::array<std::byte, sizeof(Number)> bytes;
    std::memcpy(bytes.data(), first + i * stride, sizeof(Number));
    if constexpr (swap_bytes) std::reverse(bytes.begin(), bytes.end());
    std::memcpy(&values[i], bytes.data(), sizeof(Number));
  }
}

template <std::size_t... Index>
FieldValues make_alternative(std::size_t wanted, std::size_t count, std::index_sequence<Index...>) {
  FieldValues values;
  ((Index == wanted ? static_cast<void>(values.emplace<Index>(count)) : void()), ...);
  return values;
}

template <typename To>
std::vector<To> converted(const FieldValues& values) {
  return std::visit(
      [](const auto& from) {
        std::vector<To> to(from.size());
        std::transform(from.begin(), from.end(), to.begin(),
                       [](auto value) { return static_cast<To>(value); });
        return to;
      },
      values);
}

}  // namespace

std::size_t size_of(const FieldValues& values) {
  return std::visit([](const auto& held) { return held.size(); }, values);
}

std::vector<float> to_floats(const FieldValues& values) { return converted<float>(values); }
std::vector<double> to_doubles(const FieldValues& values) { return converted<double>(values); }

ScalarType type_of(const FieldValues& values) { return static_cast<ScalarType>(values.index()); }

std::size_t bytes_of(ScalarType type) {
  constexpr std::array<std::size_t, std::variant_size_v<FieldValues>> kBytes{1, 1, 2, 2, 4,
                                                                             4, 8, 8, 4, 8};
  return kBytes.at(static_cast<std::size_t>(type));
}

FieldValues make_values(ScalarType type, std::size_t count) {
  return make_alternative(static_cast<std::size_t>(type), count,
                          std::make_index_sequence<std::variant_size_v<FieldValues>>());
}

void decode(FieldValues& values, const std::byte* first, std::size_t stride, bool swap_bytes) {
  std::visit(
      [&](auto& held) {
        using Number = typename std::decay_t<decltype(held)>::value_type;
        if (swap_bytes) {
          decode_all<Number, true>(held, first, stride);
        } else {
          decode_all<Number, false>(held, first, stride);
        }
      },
      values);
}

void encode(const FieldValues& values, std::size_t begin, std::size_t count, std::byte* first,
            std::size_t stride) {
  std::visit(
      [&](const auto& held) {
        for (std::size_t i = 0; i < count; ++i) {
          std::memcpy(first + i * stride, &held[begin + i], sizeof(held[0]));
        }
      },
      values);
}

bool parse_into(FieldValues& values, std::size_t index, std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const char* const end = text.data() + text.size();
  return std::visit(
      [&](auto& held) {
        const auto [stopped, error] = std::from_chars(text.data(), end, held[index]);
        return error == std::errc{} && stopped == end;
      },
      values);
}

void append_text(const FieldValues& values, std::size_t index, std::string& text) {
  std::visit(
      [&](const auto& held) {
        std::array<char, 32> buffer{};
        const auto [end, error] =
            std::to_chars(buffer.data(), buffer.data() + buffer.size(), held[index]);
        text.append(buffer.data(), end);
      },
      values);
}

void PointCloud::add(std::string name, FieldValues values) {
  if (!fields_.empty() && size_of(values) != size()) {
    throw std::invalid_argument(
        fmt::format("field '{}' has {} values for {} points", name, size_of(values), size()));
  }
  fields_.push_back({std::move(name), std::move(values)});
}

void PointCloud::set_rows(std::size_t rows) {
  if (rows == 0 || size() % rows != 0) {
    throw std::invalid_argument(fmt::format("{} points in {} rows", size(), rows));
  }
  rows_ = rows;
}

const FieldValues* PointCloud::find(std::string_view name) const {
  const auto found = std::find_if(fields_.begin(), fields_.end(),
                                  [&](const Field& field) { return field.name == name; });
  return found == fields_.end() ? nullptr : &found->values;
}

}  // namespace traverse::dataset
