#include "traverse/mrpt_io/mrpt_values.hpp"

#include <cstdint>
#include <cstring>
#include <string_view>

#include <mrpt/math/CMatrixFixed.h>

namespace traverse::mrpt_io {

namespace {

constexpr std::int64_t kNanosecondsPerTick = 100;
constexpr std::int64_t kTicksFrom1601To1970 = 116'444'736'000'000'000;
constexpr std::int64_t kMostTicks = 92'000'000'000'000'000;  // 9.2e9 s, of what a Stamp holds

}  // namespace

std::optional<geometry::Stamp> to_stamp(mrpt::Clock::time_point time) {
  const std::int64_t since_1601 = time.time_since_epoch().count();
  if (since_1601 <= 0) return std::nullopt;
  const std::int64_t ticks = since_1601 - kTicksFrom1601To1970;
  if (ticks < -kMostTicks || ticks > kMostTicks) return std::nullopt;
  return geometry::Stamp{ticks * kNanosecondsPerTick};
}

mrpt::Clock::time_point to_mrpt(geometry::Stamp stamp) {
  const std::int64_t half =
      stamp.nanoseconds < 0 ? -kNanosecondsPerTick / 2 : kNanosecondsPerTick / 2;
  const std::int64_t ticks = (stamp.nanoseconds + half) / kNanosecondsPerTick;
  return mrpt::Clock::time_point(mrpt::Clock::duration(ticks + kTicksFrom1601To1970));
}

geometry::Pose3 to_pose(const mrpt::poses::CPose3D& pose) {
  geometry::Pose3 result;
  const auto& R = pose.getRotationMatrix();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) result.rotation(row, column) = R(row, column);
  }
  result.translation = {pose.x(), pose.y(), pose.z()};
  return result;
}

mrpt::poses::CPose3D to_mrpt(const geometry::Pose3& pose) {
  mrpt::math::CMatrixDouble33 R;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) R(row, column) = pose.rotation(row, column);
  }
  return mrpt::poses::CPose3D::FromRotationAndTranslation(
      R, mrpt::math::TVector3D(pose.translation.x(), pose.translation.y(), pose.translation.z()));
}

bool is_set(const bool& flag) {
  std::uint8_t byte = 0;
  std::memcpy(&byte, &flag, sizeof byte);  // reading it as a bool would be undefined
  return byte == 1;
}

std::string message_of(const std::exception& error) {
  constexpr std::string_view kKey = "Message:";
  std::string_view text = error.what();
  if (const std::size_t begin = text.find(kKey); begin != std::string_view::npos) {
    text.remove_prefix(begin + kKey.size());
  }
  text = text.substr(0, text.find('\n'));
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string_view::npos ? "no reason given" : std::string(text.substr(first));
}

}  // namespace traverse::mrpt_io
