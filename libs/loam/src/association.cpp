#include "traverse/loam/association.hpp"

#include <array>
#include <optional>

#include "traverse/parallel/workers.hpp"

namespace traverse::loam {

namespace {

constexpr std::size_t kChunk = 256;
constexpr std::size_t kMostNeighbours = 16;

/// Fits a shape to the neighbours of each point; keeps the points that have one, in order.
template <typename Match, typename Fit, typename Assign>
std::vector<Match> match_points(const lidar::TimedPoints& points, const LocalMap& map,
                                const geometry::Pose3& T_map_lidar,
                                const AssociationOptions& options, int threads, const Fit& fit,
                                const Assign& assign) {
  const auto wanted = static_cast<std::size_t>(options.neighbours);
  std::vector<Match> matches(points.size());
  std::vector<std::uint8_t> found(points.size(), 0);
  parallel::Workers(threads).run_chunks(
      points.size(), kChunk, [&](std::size_t begin, std::size_t end) {
        std::array<std::uint32_t, kMostNeighbours> indices{};
        std::array<Eigen::Vector3d, kMostNeighbours> neighbours;
        for (std::size_t i = begin; i < end; ++i) {
          const Eigen::Vector3d p_lidar = points.point(i);
          const std::span<std::uint32_t> slots(indices.data(), wanted);
          if (map.nearest(T_map_lidar * p_lidar, options.search_radius_m, slots) < wanted) continue;
          for (std::size_t k = 0; k < wanted; ++k) neighbours[k] = map.points()[indices[k]];
          const auto shape = fit(std::span<const Eigen::Vector3d>(neighbours.data(), wanted));
          if (!shape) continue;
          matches[i].feature = static_cast<std::uint32_t>(i);
          matches[i].p_lidar = p_lidar;
          assign(matches[i], *shape);
          found[i] = 1;
        }
      });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (found[i] != 0) matches[kept++] = matches[i];
  }
  matches.resize(kept);
  return matches;
}

}  // namespace

void bind(config::Binder& b, AssociationOptions& o) {
  using config::Range;
  b.integer("neighbours", o.neighbours, Range::between(3, kMostNeighbours),
            "map points that a line or plane is fitted to");
  b.number("search_radius_m", o.search_radius_m, Range::positive(),
           "largest distance of these neighbours from the point");
  bind(b, o.neighbourhood);
}

Matches associate(const lidar::TimedPoints& edges, const lidar::TimedPoints& planar,
                  const LocalMap& edge_map, const LocalMap& planar_map,
                  const geometry::Pose3& T_map_lidar, const AssociationOptions& options,
                  int threads) {
  Matches matches;
  matches.lines = match_points<LineMatch>(
      edges, edge_map, T_map_lidar, options, threads,
      [&](auto neighbours) { return fit_line(neighbours, options.neighbourhood); },
      [](LineMatch& match, const Line& line) { match.line = line; });
  matches.planes = match_points<PlaneMatch>(
      planar, planar_map, T_map_lidar, options, threads,
      [&](auto neighbours) { return fit_plane(neighbours, options.neighbourhood); },
      [](PlaneMatch& match, const Plane& plane) { match.plane = plane; });
  return matches;
}

}  // namespace traverse::loam
