#include "traverse/sensors/lidar_profile.hpp"

#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"

#include "temporary_folder.hpp"

namespace traverse::sensors {
namespace {

TEST(LidarProfile, KittiProfileStatesTheKnownFacts) {
  const LidarProfile profile =
      load_lidar_profile(std::filesystem::path(TRAVERSE_SHARE_DIR) / "sensors/hdl64e_kitti.yaml");
  EXPECT_EQ(profile.rings, 64);
  EXPECT_EQ(profile.ring_source, RingSource::kStorageOrder);
  EXPECT_EQ(profile.time_source, TimeSource::kAzimuth);
  EXPECT_DOUBLE_EQ(profile.sweep_s, 0.1033);
  EXPECT_DOUBLE_EQ(profile.vertical_correction_deg, 0.205);
}

TEST(LidarProfile, RefusesAnUnknownKeyWithItsLine) {
  const traverse::testing::TemporaryFolder folder;
  files::write_text(folder / "p.yaml", "rings: 16\nbeams: 16\n");
  try {
    load_lidar_profile(folder / "p.yaml");
    FAIL() << "no error";
  } catch (const files::InputError& error) {
    EXPECT_EQ(error.place().text, "line 2");
  }
}

}  // namespace
}  // namespace traverse::sensors
