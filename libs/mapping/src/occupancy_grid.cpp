#include "traverse/mapping/occupancy_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <Eigen/Dense>
#include <fmt/core.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <opencv2/imgcodecs.hpp>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"

#include "ground_heights.hpp"

namespace traverse::mapping {

namespace {

constexpr int kBeams = 720;

/// A planar scan of obstacles, from the sensor of a keyframe.
struct ObstacleScan {
  Eigen::Vector2d origin;
  std::vector<double> obstacle_m;  ///< to the nearest obstacle of a beam; infinite without one
  std::vector<double> ground_m;    ///< to its farthest point of the ground; 0 without one
};

std::size_t beam_of(const Eigen::Vector2d& d) {
  const double turns = std::atan2(d.y(), d.x()) / (2 * std::numbers::pi) + 0.5;
  return static_cast<std::size_t>(std::min(kBeams - 1, static_cast<int>(turns * kBeams)));
}

Eigen::Vector2d direction_of(std::size_t beam) {
  const double turns = (static_cast<double>(beam) + 0.5) / kBeams - 0.5;
  const double azimuth = turns * 2 * std::numbers::pi;
  return {std::cos(azimuth), std::sin(azimuth)};
}

ObstacleScan obstacle_scan(const MapKeyframe& keyframe, const GroundHeights& ground,
                           const OccupancyOptions& options) {
  ObstacleScan scan;
  scan.origin = (keyframe.T_map_body * keyframe.p_body_sensor).head<2>();
  scan.obstacle_m.assign(kBeams, std::numeric_limits<double>::infinity());
  scan.ground_m.assign(kBeams, 0);
  for (std::size_t i = 0; i < keyframe.size(); ++i) {
    const Eigen::Vector3d p = keyframe.T_map_body * keyframe.p_body(i);
    const Eigen::Vector2d d = p.head<2>() - scan.origin;
    const double range = d.norm();
    const auto ground_z = ground.at(p);
    if (range > options.max_range_m || !ground_z) continue;
    const double height = p.z() - *ground_z;
    const std::size_t beam = beam_of(d);
    if (height < options.min_height_m) {
      scan.ground_m[beam] = std::max(scan.ground_m[beam], range);
    } else if (height <= options.max_height_m) {
      scan.obstacle_m[beam] = std::min(scan.obstacle_m[beam], range);
    }
  }
  return scan;
}

/// What one keyframe says of a cell.
enum class Seen : std::uint8_t { kNothing, kFree, kOccupied };

}  // namespace

struct OccupancyGrid::Content {
  mrpt::maps::COccupancyGridMap2D grid;
  std::vector<std::uint8_t> seen;  ///< Seen of each cell, by the keyframe at hand
  std::vector<std::size_t> touched;

  void mark(const Eigen::Vector2d& p, Seen what) {
    const int column = grid.x2idx(p.x());
    const int row = grid.y2idx(p.y());
    const int columns = static_cast<int>(grid.getSizeX());
    if (column < 0 || row < 0 || column >= columns || row >= static_cast<int>(grid.getSizeY())) {
      return;
    }
    const auto cell =
        static_cast<std::size_t>(row) * grid.getSizeX() + static_cast<std::size_t>(column);
    if (seen[cell] == 0) touched.push_back(cell);
    seen[cell] = std::max(seen[cell], static_cast<std::uint8_t>(what));  // an obstacle wins
  }

  /// Every cell counts once a keyframe, by how many beams it is met.
  void insert(const ObstacleScan& scan) {
    constexpr float kFree = 0.6F;  // probability of being free, given that one keyframe says so
    constexpr float kOccupied = 0.25F;
    const double step = grid.getResolution() / 2;
    for (std::size_t beam = 0; beam < kBeams; ++beam) {
      const Eigen::Vector2d u = direction_of(beam);
      const bool has_obstacle = std::isfinite(scan.obstacle_m[beam]);
      const double free_to = has_obstacle ? scan.obstacle_m[beam] - step : scan.ground_m[beam];
      for (double range = 0; range < free_to; range += step) {
        mark(scan.origin + range * u, Seen::kFree);
      }
      if (has_obstacle) mark(scan.origin + scan.obstacle_m[beam] * u, Seen::kOccupied);
    }
    for (const std::size_t cell : touched) {
      const bool is_free = seen[cell] == static_cast<std::uint8_t>(Seen::kFree);
      grid.updateCell(static_cast<int>(cell % grid.getSizeX()),
                      static_cast<int>(cell / grid.getSizeX()), is_free ? kFree : kOccupied);
      seen[cell] = 0;
    }
    touched.clear();
  }
};

void bind(config::Binder& b, OccupancyOptions& o) {
  using config::Range;
  b.number("cell_m", o.cell_m, Range::between(0.01, 10), "edge of a cell");
  b.number("max_range_m", o.max_range_m, Range::positive(),
           "points farther from the sensor do not count");
  b.number("min_height_m", o.min_height_m, Range::non_negative(),
           "height above the ground from which on points are obstacles");
  b.number("max_height_m", o.max_height_m, Range::positive(),
           "height above the ground up to which points are obstacles");
}

OccupancyGrid::OccupancyGrid(std::span<const MapKeyframe> keyframes,
                             const OccupancyOptions& options)
    : content_(std::make_unique<Content>()), cell_m_(options.cell_m) {
  constexpr double kMostCells = 400e6;
  const GroundHeights ground(keyframes);
  std::vector<ObstacleScan> scans;
  Eigen::AlignedBox2d box;
  for (const MapKeyframe& keyframe : keyframes) {
    const ObstacleScan& scan = scans.emplace_back(obstacle_scan(keyframe, ground, options));
    for (std::size_t beam = 0; beam < kBeams; ++beam) {
      const bool has_obstacle = std::isfinite(scan.obstacle_m[beam]);
      const double range = has_obstacle ? scan.obstacle_m[beam] : scan.ground_m[beam];
      if (range > 0) box.extend(scan.origin + range * direction_of(beam));
    }
  }
  if (box.isEmpty()) throw std::invalid_argument("no keyframe has a point for an occupancy grid");
  const Eigen::Vector2d size = box.sizes() + Eigen::Vector2d::Constant(2 * cell_m_);
  if (size.prod() > kMostCells * cell_m_ * cell_m_) {
    throw std::invalid_argument(
        fmt::format("an occupancy grid of {:.0f} m by {:.0f} m with cells of {} m would have more "
                    "than {:.0f} million cells: take larger ones",
                    size.x(), size.y(), cell_m_, kMostCells / 1e6));
  }
  const auto to_float = [](double value) { return static_cast<float>(value); };
  content_->grid.setSize(to_float(box.min().x() - cell_m_), to_float(box.max().x() + cell_m_),
                         to_float(box.min().y() - cell_m_), to_float(box.max().y() + cell_m_),
                         to_float(cell_m_), 0.5F);
  content_->seen.assign(columns() * rows(), 0);
  for (const ObstacleScan& scan : scans) content_->insert(scan);
}

OccupancyGrid::OccupancyGrid(OccupancyGrid&&) noexcept = default;
OccupancyGrid& OccupancyGrid::operator=(OccupancyGrid&&) noexcept = default;
OccupancyGrid::~OccupancyGrid() = default;

std::size_t OccupancyGrid::columns() const { return content_->grid.getSizeX(); }
std::size_t OccupancyGrid::rows() const { return content_->grid.getSizeY(); }

Eigen::Vector2d OccupancyGrid::origin() const {
  return {content_->grid.getXMin(), content_->grid.getYMin()};
}

double OccupancyGrid::occupancy(const Eigen::Vector2d& p_map) const {
  const auto& grid = content_->grid;
  const int column = grid.x2idx(p_map.x());
  const int row = grid.y2idx(p_map.y());
  const bool is_inside = column >= 0 && row >= 0 && column < static_cast<int>(columns()) &&
                         row < static_cast<int>(rows());
  return is_inside ? 1 - grid.getCell(column, row) : 0.5;
}

void OccupancyGrid::write(const std::filesystem::path& png,
                          const std::filesystem::path& yaml) const {
  // Values and thresholds of ROS' own map saver.
  constexpr double kOccupied = 0.65;
  constexpr double kFree = 0.196;
  const int image_rows = static_cast<int>(rows());
  const int image_columns = static_cast<int>(columns());
  cv::Mat_<std::uint8_t> image(image_rows, image_columns);
  for (int row = 0; row < image_rows; ++row) {  // the image's first row is the map's last
    for (int column = 0; column < image_columns; ++column) {
      const double occupied = 1 - content_->grid.getCell(column, image_rows - 1 - row);
      image(row, column) = occupied > kOccupied ? 0 : occupied < kFree ? 254 : 205;
    }
  }
  std::vector<unsigned char> bytes;
  if (!cv::imencode(".png", image, bytes)) {
    throw files::OutputError(png, "the picture could not be compressed");
  }
  files::AtomicFile file(png);
  file.stream().write(reinterpret_cast<const char*>(bytes.data()),
                      static_cast<std::streamsize>(bytes.size()));
  file.commit();
  files::write_text(yaml, fmt::format("image: {}\n"
                                      "mode: trinary\n"
                                      "resolution: {}\n"
                                      "origin: [{:.6f}, {:.6f}, 0.0]\n"
                                      "negate: 0\n"
                                      "occupied_thresh: {}\n"
                                      "free_thresh: {}\n",
                                      png.filename().string(), cell_m_, origin().x(), origin().y(),
                                      kOccupied, kFree));
}

}  // namespace traverse::mapping
