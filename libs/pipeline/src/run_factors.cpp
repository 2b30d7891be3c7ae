#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"
#include "traverse/inertial/factor_kinds.hpp"
#include "traverse/pipeline/factor_kinds.hpp"
#include "traverse/pipeline/run_contents.hpp"

namespace traverse::pipeline {

namespace {

constexpr double kGravity_mps2 = 9.80665;  // a Jacobian does not ask where on earth it is

Eigen::Vector3d vector_at(const FrameTable& frames, std::size_t row, const std::string& before,
                          const std::array<const char*, 3>& axes, const std::string& behind) {
  Eigen::Vector3d result;
  for (int k = 0; k < 3; ++k) {
    result[k] = frames.column(before + axes.at(static_cast<std::size_t>(k)) + behind).at(row);
  }
  return result;
}

inertial::NavState state_at(const RunContents& run, std::size_t row) {
  static constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};
  static constexpr std::array<const char*, 3> kDirections{"east", "north", "up"};
  inertial::NavState x;
  x.stamp = run.estimate.stamp(row);
  x.q_map_body = Eigen::Quaterniond(run.estimate.pose(row).rotation);
  x.p_map = run.estimate.pose(row).translation;
  x.v_map = vector_at(run.frames, row, "velocity_", kDirections, "_mps");
  x.gyro_bias = vector_at(run.frames, row, "gyro_bias_", kAxes, "_rad_s");
  x.accelerometer_bias = vector_at(run.frames, row, "accelerometer_bias_", kAxes, "_m_s2");
  return x;
}

}  // namespace

bool tells_states(const RunContents& run) {
  return run.frames.has("velocity_east_mps") && run.frames.has("gyro_bias_x_rad_s");
}

std::vector<optimization::FactorKind> factor_kinds_of_run(const RunFolder& folder,
                                                          std::size_t frame) {
  return factor_kinds_of_run(read_run(folder, RunPart::kFrames), frame);
}

std::vector<optimization::FactorKind> factor_kinds_of_run(const RunContents& run,
                                                          std::size_t frame) {
  if (!tells_states(run)) {
    throw files::InputError(run.folder.frames(), files::Place::line(1),
                            "the states of a navigation run of version 0.2 (velocity_east_mps, "
                            "gyro_bias_x_rad_s, ...)",
                            "others");
  }
  const std::vector<double> numbers = run.frames.column("frame");
  const auto found = std::find(numbers.begin(), numbers.end(), static_cast<double>(frame));
  if (found == numbers.end() || found == numbers.begin()) {
    throw files::InputError(run.folder.frames(), files::Place::whole_file(),
                            numbers.size() < 2
                                ? std::string("two frames")
                                : fmt::format("a frame from {} to {}", numbers[1], numbers.back()),
                            std::to_string(frame));
  }
  const auto row = static_cast<std::size_t>(found - numbers.begin());
  return inertial::inertial_kinds_between(state_at(run, row - 1), state_at(run, row),
                                          {0, 0, -kGravity_mps2});
}

std::string book_name(const std::string& factor, const std::string& block) {
  static const std::map<std::string, std::string> kRows{
      {"inertial rotation", "dR"}, {"inertial velocity", "dv"}, {"inertial position", "dp"}};
  static const std::map<std::string, std::string> kParts{{"rotation", "R"},
                                                         {"position", "p"},
                                                         {"velocity", "v"},
                                                         {"gyro bias", "bg"},
                                                         {"accelerometer bias", "ba"}};
  const auto row = kRows.find(factor);
  if (row == kRows.end()) return block;
  const auto part = kParts.find(block.substr(0, block.size() - 2));  // without " i" or " j"
  return fmt::format("{}/d{}{}", row->second, part->second, block.back() == 'i' ? 1 : 2);
}

}  // namespace traverse::pipeline
