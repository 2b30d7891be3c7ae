#include <filesystem>
#include <fstream>
#include <ostream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/evaluation/consistency.hpp"

#include "test_data.hpp"

namespace traverse::evaluation {
namespace {

/// A drive, poses that come with it, and the score that is known of them.
struct KnownScore {
  std::string drive;
  std::string poses;
  std::size_t scans;
  std::size_t queries;
  std::size_t planar;
  std::string mme;     ///< as printed, four decimals
  std::string mpv_cm;  ///< as printed, four decimals
};

void PrintTo(const KnownScore& known, std::ostream* stream) {
  *stream << known.drive << " with " << known.poses;
}

class ConsistencyDrives : public ::testing::TestWithParam<KnownScore> {};

TEST_P(ConsistencyDrives, TheKnownScoreComesOut) {
  const KnownScore& known = GetParam();
  const auto folder = testing::kitti_drive(known.drive);
  if (!std::filesystem::exists(folder / "velodyne")) GTEST_SKIP() << "no drive in " << folder;
  const auto T_map_lidar =
      dataset::read_trajectory(folder / known.poses, dataset::TrajectoryFormat::kKitti);

  ConsistencyScorer scorer("raw");
  for (std::size_t k = 0; k < known.scans; ++k) {
    const auto file = folder / "velodyne" / fmt::format("{:06}.bin", k);
    std::vector<float> xyzi(std::filesystem::file_size(file) / sizeof(float));
    std::ifstream(file, std::ios::binary)
        .read(reinterpret_cast<char*>(xyzi.data()),
              static_cast<std::streamsize>(xyzi.size() * sizeof(float)));
    std::vector<float> x, y, z;
    for (std::size_t i = 0; i < xyzi.size(); i += 4) {
      x.push_back(xyzi[i]);
      y.push_back(xyzi[i + 1]);
      z.push_back(xyzi[i + 2]);
    }
    scorer.add(x, y, z, T_map_lidar.pose(k));
  }

  const auto found = scorer.score();
  ASSERT_TRUE(found && found->point_to_plane);
  EXPECT_EQ(found->queries, known.queries);
  EXPECT_EQ(found->point_to_plane->queries, known.planar);
  EXPECT_EQ(fmt::format("{:.4f}", found->mme), known.mme);
  EXPECT_EQ(fmt::format("{:.4f}", 100 * found->mpv_m), known.mpv_cm);
}

INSTANTIATE_TEST_SUITE_P(Kitti, ConsistencyDrives,
                         ::testing::Values(KnownScore{"2011_09_26_drive_0001", "poses_velo.txt",
                                                      108, 79125, 37273, "-1.6519", "6.0161"},
                                           KnownScore{"2011_09_26_drive_0005",
                                                      "poses_velo_velint.txt", 100, 69067, 8238,
                                                      "-1.1575", "9.3931"},
                                           KnownScore{"2011_09_26_drive_0005", "poses_velo.txt",
                                                      100, 69055, 2110, "-0.8024", "13.2218"}));

}  // namespace
}  // namespace traverse::evaluation
