#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "point_clouds/point_fields.hpp"

namespace traverse::dataset {

/// The rule of interpret_points() for times. \param returns whether each point of each sample is a
/// return: the times of others count for nothing
std::optional<PointTimeRule> find_point_time(std::span<const PointSample> samples,
                                             std::span<const std::vector<bool>> returns,
                                             const PointFieldHints& hints,
                                             std::vector<Fact>& facts);

/// Seconds after the scan's stamp of each point. \param scan with stamp and coordinates
/// \throws files::InputError if the column is missing or the times span more than a sweep can.
std::vector<float> point_times(const PointColumns& points, const PointTimeRule& rule,
                               const sensors::LidarScan& scan, const std::filesystem::path& where);

}  // namespace traverse::dataset
