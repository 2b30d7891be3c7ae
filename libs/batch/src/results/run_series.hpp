#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "traverse/batch/job.hpp"
#include "traverse/evaluation/bootstrap.hpp"

namespace traverse::batch {

/// Where the folder of a run is.
using RunFolderOf = std::function<std::filesystem::path(const Job&)>;

/// The errors along the drive of which a metric is a figure, of runs in their folders, each read
/// once. Known of position errors, APE and RPE over 10 frames.
class RunSeries {
 public:
  RunSeries(const std::string& metric, RunFolderOf folder_of);

  bool is_known() const { return is_ape_ || is_rpe_; }
  /// Half of the 95 % interval of the difference of the metric between two runs of one recording,
  /// by the paired moving-block bootstrap over the moments that both have; nothing for too few.
  /// \throws files::InputError for a run that cannot be read
  std::optional<double> half_of_difference(const Job& first, const Job& second);

 private:
  using Series = std::map<std::int64_t, double>;  ///< by the stamp that an error belongs to
  const Series& of(const Job& job);

  RunFolderOf folder_of_;
  evaluation::Figure figure_ = evaluation::Figure::kRmse;
  bool is_ape_ = false;
  bool is_rpe_ = false;
  std::map<std::string, Series> read_;  ///< by the job's id
};

}  // namespace traverse::batch
