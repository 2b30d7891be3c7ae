#include "saved_estimate.hpp"

#include <utility>
#include <vector>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/files/atomic_file.hpp"

namespace traverse::replay {

namespace {

dataset::PointCloud cloud_of(const MapHistory& map, std::size_t size) {
  std::vector<float> x, y, z;
  for (std::size_t i = 0; i < size; ++i) {
    x.push_back(map.points()[i].x());
    y.push_back(map.points()[i].y());
    z.push_back(map.points()[i].z());
  }
  const auto end = map.intensities().begin() + static_cast<std::ptrdiff_t>(size);
  dataset::PointCloud cloud;
  cloud.add("x", std::move(x));
  cloud.add("y", std::move(y));
  cloud.add("z", std::move(z));
  cloud.add("intensity", std::vector<float>(map.intensities().begin(), end));
  return cloud;
}

}  // namespace

std::size_t save_estimate(const std::filesystem::path& folder, const geometry::Trajectory& estimate,
                          const MapHistory& map,
                          const std::optional<dataset::Reference>& reference) {
  if (folder.has_parent_path()) files::make_writable_folder(folder.parent_path());
  files::AtomicFolder made(folder);
  const std::filesystem::path& place = made.temporary_path();
  dataset::write_tum(place / "trajectory.tum", estimate);
  if (reference) dataset::write_tum(place / "reference.tum", reference->T_map_body);
  const std::size_t points = map.size_at(estimate.size());
  dataset::write_ply(place / "map.ply", cloud_of(map, points));
  made.commit();
  return points;
}

}  // namespace traverse::replay
