#pragma once

#include "run/model.hpp"
#include "run/run_data.hpp"

namespace traverse::report {

/// How far poses are off the first one's truth, in the axes of the body, within the bounds that the
/// run's own covariances set (frames.csv); nothing where frames have none. Of a run that closes
/// loops, its odometry's: the covariances are.
void add_covariance_chart(const RunData& run, Json& charts);

}  // namespace traverse::report
