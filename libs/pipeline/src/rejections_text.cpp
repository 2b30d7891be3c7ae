#include "traverse/pipeline/rejections_text.hpp"

#include <fmt/format.h>

namespace traverse::pipeline {

std::string rejections_text(const SensorUse& sensor) {
  const double longest_s = sensor.longest_rejected_s;
  if (longest_s <= 0) return sensor.rejected == 1 ? "that one alone" : "no two in a row";
  return longest_s < 9.95 ? fmt::format("in stretches of up to {:.2g} s", longest_s)
                          : fmt::format("in stretches of up to {:.0f} s", longest_s);
}

}  // namespace traverse::pipeline
