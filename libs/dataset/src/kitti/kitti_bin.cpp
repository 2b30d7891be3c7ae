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

template <typename Number>
void fill(std::span<const std::byte> bytes, std::size_t columns, sensors::LidarScan& scan) {
  const std::size_t points = bytes.size() / (columns * sizeof(Number));
  const std::array<std::vector<float>*, 4> values{&scan.x, &scan.y, &scan.z, &scan.intensity};
  const std::size_t read = std::min(columns, values.size());
  for (std::size_t k = 0; k < read; ++k) values[k]->resize(points);
  std::array<Number, 4> point{};
  for (std::size_t i = 0; i < points; ++i) {
    std::memcpy(point.data(), bytes.data() + i * columns * sizeof(Number), read * sizeof(Number));
    for (std::size_t k = 0; k < read; ++k) (*values[k])[i] = static_cast<float>(point[k]);
  }
}

}  // namespace

void bind(config::Binder& b, BinLayout& layout) {
  static constexpr std::array<std::pair<std::string_view, BinType>, 2> kTypes{
      {{"float32", BinType::kFloat32}, {"float64", BinType::kFloat64}}};
  b.integer("columns", layout.columns, config::Range::between(3, 64), "numbers of a point");
  b.choice("type", layout.type, kTypes, "of a number");
}

sensors::LidarScan read_kitti_bin(const std::filesystem::path& file, const BinLayout& layout) {
  const std::vector<std::byte> bytes = files::read_bytes(file);
  const auto columns = static_cast<std::size_t>(layout.columns);
  const std::size_t point_bytes =
      columns * (layout.type == BinType::kFloat32 ? sizeof(float) : sizeof(double));
  if (bytes.size() % point_bytes != 0) {
    throw files::InputError(file, files::Place::whole_file(),
                            fmt::format("whole points of {} bytes", point_bytes),
                            fmt::format("{} bytes", bytes.size()));
  }
  sensors::LidarScan scan;
  if (layout.type == BinType::kFloat32) {
    fill<float>(bytes, columns, scan);
  } else {
    fill<double>(bytes, columns, scan);
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
