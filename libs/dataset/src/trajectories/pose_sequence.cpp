#include "trajectories/pose_sequence.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "traverse/files/numbers.hpp"

namespace traverse::dataset {

namespace {

/// Through the wider type, so that what a round trip changes is the rounding of the four numbers in
/// the file and nothing else.
Eigen::Matrix3d rotation_of(const Eigen::Quaterniond& q) {
  return q.cast<long double>().normalized().toRotationMatrix().cast<double>();
}

}  // namespace

double finite_number(const files::LineReader& reader, std::string_view word) {
  const auto number = files::parse_double(word);
  if (!number || !std::isfinite(*number)) {
    throw reader.error("a finite number", files::in_quotes(word));
  }
  return *number;
}

void PosesInOrder::add(const files::LineReader& reader, const std::optional<geometry::Stamp>& stamp,
                       const Eigen::Vector3d& t, const Eigen::Vector4d& columns) {
  if (last_ && stamp && *stamp < *last_) {
    throw reader.error(fmt::format("a stamp not before the last one, {}", to_text(*last_)),
                       to_text(*stamp));
  }
  last_ = stamp;
  require_length(reader, columns.norm());
  order_.add(t, columns);
  const Eigen::Quaterniond q =
      is_w_first_ ? Eigen::Quaterniond(columns[0], columns[1], columns[2], columns[3])
                  : Eigen::Quaterniond(columns[3], columns[0], columns[1], columns[2]);
  take_(stamp, {rotation_of(q), t});
}

std::vector<std::string> PosesInOrder::notes() const {
  std::vector<std::string> list;
  if (normalised_ > 0) {
    list.push_back(fmt::format("{} quaternion{} of length {:.4g} to {:.4g} {} normalised",
                               normalised_, normalised_ == 1 ? "" : "s", shortest_, longest_,
                               normalised_ == 1 ? "was" : "were"));
  }
  if (auto hint = order_.hint(is_w_first_)) list.push_back(std::move(*hint));
  return list;
}

void PosesInOrder::require_length(const files::LineReader& reader, double length) {
  constexpr double kMostOff = 0.1;
  constexpr double kRounding = 2e-3;  // of files with three decimals
  if (!(std::abs(length - 1) <= kMostOff)) {
    throw reader.error("a quaternion of length 1", fmt::format("one of length {:.4g}", length));
  }
  if (std::abs(length - 1) <= kRounding) return;
  shortest_ = normalised_ == 0 ? length : std::min(shortest_, length);
  longest_ = normalised_ == 0 ? length : std::max(longest_, length);
  ++normalised_;
}

}  // namespace traverse::dataset
