#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "traverse/evaluation/bootstrap.hpp"

#include "run/run_data.hpp"

namespace traverse::report {

/// Values of a run by the moment they belong to, so that runs can be compared moment by moment.
using Series = std::map<std::int64_t, double>;

/// What the figure `id` of run_figures.hpp is made of; empty if the run does not define it or keeps
/// no values. Errors go by the stamp of the pose, KITTI segments by their start and length, times
/// by the number of the frame.
Series series_of(const RunData& run, const std::string& id);

/// The figures that have a series, and how their value follows from it.
struct SeriesFigure {
  std::string id;
  evaluation::Figure figure;
};
const std::vector<SeriesFigure>& series_figures();

/// Both series where both have a value, in the order of time.
struct CommonValues {
  std::vector<double> first;
  std::vector<double> second;
};
CommonValues common_values(const Series& first, const Series& second);

}  // namespace traverse::report
