#include "traverse/pipeline/run_folder.hpp"

#include <system_error>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"

namespace traverse::pipeline {

void RunFolder::prepare() const {
  files::make_writable_folder(path);
  for (const auto& place :
       {record(),     trajectory(),   utm_trajectory(), odometry(),     odometry_evaluation(),
        loops(),      keyframes(),    reference(),      frames(),       map_points(),
        simple_map(), origin(),       sample_scan(),    worst_frames(), evaluation(),
        jacobians(),  factor_bench(), images(),         report(),       report_json()}) {
    std::error_code failure;
    std::filesystem::remove_all(place, failure);
    if (failure) throw files::OutputError(place, failure.message());
  }
}

}  // namespace traverse::pipeline
