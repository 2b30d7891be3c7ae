#include "kitti/kitti_bin.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/binary_file.hpp"
#include "traverse/files/input_error.hpp"

namespace traverse::dataset {

static_assert(std::endian::native == std::endian::little, "KITTI files are little-endian");

namespace {

using KittiPoint = std::array<float, 4>;

}  // namespace

sensors::LidarScan read_kitti_bin(const std::filesystem::path& file) {
  const std::vector<std::byte> bytes = files::read_bytes(file);
  if (bytes.size() % sizeof(KittiPoint) != 0) {
    throw files::InputError(file, files::Place::whole_file(),
                            fmt::format("whole points of {} bytes", sizeof(KittiPoint)),
                            fmt::format("{} bytes", bytes.size()));
  }
  const std::size_t points = bytes.size() / sizeof(KittiPoint);
  sensors::LidarScan scan;
  for (auto* values : {&scan.x, &scan.y, &scan.z, &scan.intensity}) values->resize(points);
  for (std::size_t i = 0; i < points; ++i) {
    KittiPoint point{};
    std::memcpy(point.data(), bytes.data() + i * sizeof point, sizeof point);
    scan.x[i] = point[0];
    scan.y[i] = point[1];
    scan.z[i] = point[2];
    scan.intensity[i] = point[3];
  }
  return scan;
}

void write_kitti_bin(const std::filesystem::path& file, const sensors::LidarScan& scan) {
  std::vector<KittiPoint> points(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    points[i] = {scan.x[i], scan.y[i], scan.z[i],
                 scan.intensity.empty() ? 0.0F : scan.intensity[i]};
  }
  files::AtomicFile output(file);
  output.stream().write(reinterpret_cast<const char*>(points.data()),
                        static_cast<std::streamsize>(points.size() * sizeof(KittiPoint)));
  output.commit();
}

}  // namespace traverse::dataset
