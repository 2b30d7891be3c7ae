#include "traverse/loam/association.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "geometry/random_motion.hpp"
#include "loam/room.hpp"

namespace traverse::loam {
namespace {

using testing::Room;

class AssociationTest : public ::testing::Test {
 protected:
  Room room{0.2};
  LocalMap edge_map = Room::map_of(room.edges);
  LocalMap planar_map = Room::map_of(room.planar);
  testing::RandomMotion random{1};
  geometry::Pose3 T_map_lidar = random.pose(0.5, 1);
  lidar::TimedPoints edges = testing::seen_from(T_map_lidar, room.edges);
  lidar::TimedPoints planar = testing::seen_from(T_map_lidar, room.planar);

  Matches match(int threads) {
    return associate(edges, planar, edge_map, planar_map, T_map_lidar, AssociationOptions{},
                     threads);
  }
};

TEST_F(AssociationTest, FindsUprightCornersAndAxisAlignedWalls) {
  const Matches matches = match(1);
  EXPECT_EQ(matches.lines.size(), room.edges.size());
  EXPECT_GT(matches.planes.size(), room.planar.size() / 2);
  for (const LineMatch& m : matches.lines) EXPECT_GT(std::abs(m.line.direction.z()), 0.999);
  for (const PlaneMatch& m : matches.planes) {
    EXPECT_LT(std::abs(plane_residual(m.plane, T_map_lidar * m.p_lidar)), 0.2);
  }
}

TEST_F(AssociationTest, IsTheSameForAnyNumberOfThreads) {
  const Matches one = match(1);
  for (const int threads : {2, 4}) {
    const Matches many = match(threads);
    ASSERT_EQ(one.planes.size(), many.planes.size());
    for (std::size_t i = 0; i < one.planes.size(); ++i) {
      EXPECT_EQ(one.planes[i].feature, many.planes[i].feature);
      EXPECT_EQ(one.planes[i].plane.normal, many.planes[i].plane.normal);
      EXPECT_EQ(one.planes[i].plane.offset, many.planes[i].plane.offset);
    }
  }
}

TEST_F(AssociationTest, FarFromTheMapNothingMatches) {
  T_map_lidar.translation.x() += 100;
  EXPECT_EQ(match(1).size(), 0U);
}

}  // namespace
}  // namespace traverse::loam
