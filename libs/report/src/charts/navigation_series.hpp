#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "traverse/pipeline/frame_table.hpp"

/// Series of a navigation run that its charts and its pictures need.
namespace traverse::report {

/// The factor kinds whose innovations are recorded: their prefix in frames.csv and their name.
inline constexpr std::array<std::pair<const char*, const char*>, 5> kInnovationKinds{
    {{"gnss", "GNSS"},
     {"heading", "heading"},
     {"wheels", "wheels"},
     {"standing", "stand-still"},
     {"inertial", "inertial"}}};

/// Chi-square over its rows of a factor kind; NaN where there was none.
std::vector<double> innovations(const pipeline::FrameTable& frames, const std::string& prefix);

/// Residuals of fixes along "east", "north" or "up" [m], those taken or those rejected; NaN else.
std::vector<double> fix_residuals(const pipeline::FrameTable& frames, const std::string& direction,
                                  bool are_rejected);

/// What is estimated beside the motion: three times its deviation is the band about it.
struct Estimated {
  std::string name;
  std::vector<double> values;
  std::vector<double> three_sigma;
};
/// Of a column and that of its deviation.
Estimated estimated(const pipeline::FrameTable& frames, std::string name, const std::string& column,
                    const std::string& sigma);
/// The same less its last value, by `factor`: what it went through shows, whatever it is.
Estimated less_its_end(Estimated one, double factor = 1);
/// The three axes of a bias, less their ends: "gyro", "rad_s" or "accelerometer", "m_s2".
std::vector<Estimated> bias_axes(const pipeline::FrameTable& frames, const std::string& sensor,
                                 const std::string& unit);

/// A step of the path at a fix that the prediction misses by more than that is a jump [m]: what a
/// vehicle that follows its lane by the path would steer after.
inline constexpr double kJump_m = 0.05;

/// Of frames by fixes what `column` says, "correction_m" or "roughness_m"; NaN elsewhere, and where
/// it is not told (-1). Estimators that make states at other moments too are alike in these.
std::vector<double> at_fixes(const pipeline::FrameTable& frames, const std::string& column);

/// Fixes where they put the body, map frame [m], in the order of time.
struct PlacedFixes {
  std::vector<Eigen::Vector3d> taken;
  std::vector<Eigen::Vector3d> rejected;
};
PlacedFixes placed_fixes(const pipeline::FrameTable& frames);

bool has_any(const std::vector<double>& values);
bool is_navigation(const pipeline::FrameTable& frames);

}  // namespace traverse::report
