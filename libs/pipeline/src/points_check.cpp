#include "points_check.hpp"

#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"

namespace traverse::pipeline {

namespace {

using files::InputError;
using files::Place;

constexpr double kMostOffset_m = 1e9;

}  // namespace

void require_values(const dataset::PointCloud& cloud, const std::filesystem::path& file,
                    const std::string& field, double least, double most, IsWhole is_whole) {
  if (cloud.find(field) == nullptr) {
    throw InputError(file, Place::whole_file(), "a field " + field, "none");
  }
  require_values_if_there(cloud, file, field, least, most, is_whole);
}

void require_values_if_there(const dataset::PointCloud& cloud, const std::filesystem::path& file,
                             const std::string& field, double least, double most,
                             IsWhole is_whole) {
  const dataset::FieldValues* found = cloud.find(field);
  if (found == nullptr) return;
  const std::vector<double> values = dataset::to_doubles(*found);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double value = values[i];
    const bool fits =
        value >= least && value <= most && (is_whole == IsWhole::kNo || value == std::floor(value));
    if (fits) continue;
    throw InputError(
        file, {fmt::format("point {}, field {}", i, field)},
        fmt::format("{} from {} to {}", is_whole == IsWhole::kYes ? "a whole number" : "a number",
                    least, most),
        fmt::format("{}", value));
  }
}

void require_size(const dataset::PointCloud& cloud, const std::filesystem::path& file,
                  std::size_t points) {
  if (cloud.size() == points) return;
  throw InputError(file, Place::whole_file(),
                   fmt::format("the {} points that run.json counts (map.points)", points),
                   fmt::format("{}", cloud.size()));
}

void require_worst_frames(const dataset::PointCloud& cloud, const RunFolder& folder,
                          const FrameTable& frames) {
  const std::filesystem::path file = folder.worst_frames();
  const std::vector<double> numbers = frames.column("frame");
  require_values(cloud, file, "frame", numbers.front(), numbers.back(), IsWhole::kYes);
  require_values(cloud, file, "kind", 0, 2, IsWhole::kYes);
  for (const char* field : {"residual_m", "offset_x", "offset_y", "offset_z"}) {
    require_values_if_there(cloud, file, field, -kMostOffset_m, kMostOffset_m, IsWhole::kNo);
  }
}

}  // namespace traverse::pipeline
