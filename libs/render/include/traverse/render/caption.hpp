#pragma once

#include <string>

namespace traverse::render {

/// What a picture says about itself, so that it can stand alone. Any part may be empty.
struct Caption {
  std::string title;      ///< "Trajectory from above"; empty: the picture's usual title
  std::string statistic;  ///< "APE rmse 0.184 m, SE(3)-aligned, 108 pairs"
  std::string recording;  ///< "2011_09_26_drive_0001"
  std::string preset;     ///< "floam"
  std::string date;       ///< "2025-11-22"
};

}  // namespace traverse::render
