#include "traverse/mapping/occupancy_grid.hpp"

#include <cmath>
#include <stdexcept>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <yaml-cpp/yaml.h>

#include "traverse/geometry/angle.hpp"
#include "traverse/simulation/analytic_scene.hpp"

#include "temporary_folder.hpp"

namespace traverse::mapping {
namespace {

/// A yard of 20 m by 12 m with a box in it, a beam to drive under and a kerb, seen from two places.
std::vector<MapKeyframe> yard() {
  simulation::AnalyticScene scene;
  scene.add(simulation::Rectangle{{-10, -6, 0}, {20, 0, 0}, {0, 12, 0}});
  scene.add(simulation::Rectangle{{-10, -6, 0}, {20, 0, 0}, {0, 0, 4}});
  scene.add(simulation::Rectangle{{-10, 6, 0}, {20, 0, 0}, {0, 0, 4}});
  scene.add(simulation::Rectangle{{-10, -6, 0}, {0, 12, 0}, {0, 0, 4}});
  scene.add(simulation::Rectangle{{10, -6, 0}, {0, 12, 0}, {0, 0, 4}});
  scene.add_box({4, 0, 0}, {2, 2, 1.5}, 0, 0.5);
  scene.add_box({-6, 3, 0}, {2, 1, 0.15}, 0, 0.5);                          // kerb
  scene.add(simulation::Rectangle{{0, -6, 2.5}, {0, 12, 0}, {0, 0, 0.5}});  // beam
  std::vector<MapKeyframe> keyframes;
  for (const double x : {-3.0, -2.0}) {
    MapKeyframe keyframe;
    keyframe.T_map_body.translation = {x, 0, 0};
    keyframe.p_body_sensor = {0, 0, 1.8};
    const Eigen::Vector3d origin(x, 0, 1.8);
    for (double e = -40; e <= 20; e += 0.5) {
      for (double a = 0; a < 360; a += 0.25) {
        const Eigen::Vector3d u(std::cos(e * geometry::kDegree) * std::cos(a * geometry::kDegree),
                                std::cos(e * geometry::kDegree) * std::sin(a * geometry::kDegree),
                                std::sin(e * geometry::kDegree));
        const auto hit = scene.first_hit(origin, u, 50);
        if (!hit) continue;
        const Eigen::Vector3d p = hit->distance_m * u + keyframe.p_body_sensor;
        keyframe.x.push_back(static_cast<float>(p.x()));
        keyframe.y.push_back(static_cast<float>(p.y()));
        keyframe.z.push_back(static_cast<float>(p.z()));
      }
    }
    for (int twice = 0; twice < 4; ++twice) keyframes.push_back(keyframe);
  }
  return keyframes;
}

TEST(OccupancyGrid, KnowsWallsObstaclesAndWhatOneCanDriveOverAndUnder) {
  const OccupancyGrid grid(yard(), {});
  EXPECT_GT(grid.occupancy({-2.5, 5.98}), 0.9);    // wall
  EXPECT_GT(grid.occupancy({3.02, 0.2}), 0.9);     // front of the box
  EXPECT_LT(grid.occupancy({-6, 3}), 0.1);         // kerb
  EXPECT_LT(grid.occupancy({0, -3}), 0.1);         // below the beam
  EXPECT_LT(grid.occupancy({-4, -4}), 0.1);        // yard
  EXPECT_NEAR(grid.occupancy({4, 0}), 0.5, 0.01);  // inside of the box
  EXPECT_NEAR(grid.occupancy({7, 0}), 0.5, 0.01);  // behind it
  EXPECT_EQ(grid.occupancy({100, 100}), 0.5);
}

TEST(OccupancyGrid, IsWrittenAsMapServersReadIt) {
  const testing::TemporaryFolder folder;
  const OccupancyGrid grid(yard(), {});
  grid.write(folder / "grid.png", folder / "grid.yaml");
  const YAML::Node yaml = YAML::LoadFile((folder / "grid.yaml").string());
  const cv::Mat image =
      cv::imread((folder / yaml["image"].as<std::string>()).string(), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(image.type(), CV_8UC1);
  ASSERT_EQ(image.cols, static_cast<int>(grid.columns()));
  ASSERT_EQ(image.rows, static_cast<int>(grid.rows()));
  EXPECT_EQ(yaml["negate"].as<int>(), 0);
  const double resolution = yaml["resolution"].as<double>();
  // The server's own arithmetic: pixel (row, column) to the map, value to a probability.
  const auto value = [&](double x, double y) {
    const double column = (x - yaml["origin"][0].as<double>()) / resolution;
    const double row = image.rows - 1 - (y - yaml["origin"][1].as<double>()) / resolution;
    const int pixel = image.at<std::uint8_t>(static_cast<int>(std::ceil(row)),
                                             static_cast<int>(std::floor(column)));
    return (255 - pixel) / 255.0;
  };
  EXPECT_GT(value(-2.5, 5.98), yaml["occupied_thresh"].as<double>());
  EXPECT_LT(value(-4, -4), yaml["free_thresh"].as<double>());
  const double unknown = value(7, 0);
  EXPECT_GT(unknown, yaml["free_thresh"].as<double>());
  EXPECT_LT(unknown, yaml["occupied_thresh"].as<double>());
}

TEST(OccupancyGrid, SaysWhenItCannotBeMade) {
  EXPECT_THROW(OccupancyGrid({}, {}), std::invalid_argument);
  std::vector<MapKeyframe> far_apart = yard();
  far_apart.back().T_map_body.translation.x() = 1e6;
  far_apart.back().T_map_body.translation.y() = 1e6;
  EXPECT_THROW(OccupancyGrid(far_apart, {}), std::invalid_argument);
}

}  // namespace
}  // namespace traverse::mapping
