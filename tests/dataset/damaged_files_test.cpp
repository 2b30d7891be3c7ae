#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"

#include "dataset/made_recordings.hpp"
#include "dataset/rawlog_maker.hpp"
#include "temporary_folder.hpp"

namespace traverse::dataset {
namespace {

namespace fs = std::filesystem;
using namespace traverse::testing;  // made recordings and rawlogs

/// Repeatable damage: a few bytes changed, some lost, or a piece doubled.
class Damage {
 public:
  std::string apply(std::string bytes) {
    for (std::size_t i = 0, changes = 1 + pick(4); i < changes && !bytes.empty(); ++i) {
      const std::size_t place = pick(bytes.size());
      switch (pick(4)) {
        case 0:
          bytes[place] = static_cast<char>(pick(256));
          break;
        case 1:
          bytes[place] = static_cast<char>(bytes[place] ^ (1 << pick(8)));
          break;
        case 2:
          bytes.erase(place, 1 + pick(20));
          break;
        default:
          bytes.insert(place, bytes.substr(pick(bytes.size()), pick(20)));
      }
    }
    return bytes;
  }

 private:
  std::size_t pick(std::size_t below) { return generator_() % below; }
  std::mt19937 generator_{12345};
};

/// Damages `file` again and again; whatever comes of it, `use` must return or throw an InputError.
void expect_graceful(const fs::path& file, const std::function<void()>& use) {
  constexpr int kRepeats = 400;
  const std::string whole = files::read_text(file);
  Damage damage;
  int refused = 0;
  for (int i = 0; i < kRepeats; ++i) {
    files::write_text(file, damage.apply(whole));
    try {
      use();
    } catch (const files::InputError&) {
      ++refused;
    } catch (const std::exception& error) {
      FAIL() << file << ", damage " << i << ": " << error.what();
    }
  }
  EXPECT_LT(refused, kRepeats) << "nothing but refusals tests little";
  files::write_text(file, whole);
  EXPECT_NO_THROW(use());
}

void read_recording(const fs::path& path) { read_all(*open(path)); }

PointCloud small_cloud() {
  PointCloud cloud;
  for (const char* name : {"x", "y", "z"}) cloud.add(name, std::vector<float>(40, 1.5F));
  cloud.add("ring", std::vector<std::uint16_t>(40, 3));
  cloud.add("time", std::vector<double>(40, 0.01));
  return cloud;
}

TEST(DamagedFiles, PointClouds) {
  const TemporaryFolder folder;
  for (const auto encoding : {PointEncoding::kAscii, PointEncoding::kBinary}) {
    write_pcd(folder / "a.pcd", small_cloud(), encoding);
    expect_graceful(folder / "a.pcd", [&] { read_point_cloud(folder / "a.pcd"); });
    expect_graceful(folder / "a.pcd", [&] { read_recording(folder.path()); });
    write_ply(folder / "a.ply", small_cloud(), encoding);
    expect_graceful(folder / "a.ply", [&] { read_point_cloud(folder / "a.ply"); });
  }
}

TEST(DamagedFiles, RawlogsPlainAndCompressed) {
  const TemporaryFolder folder;
  {
    RawlogMaker maker(folder / "a.rawlog");
    for (int i = 0; i < 10; ++i) {
      maker.add(made_imu(0.1 * i));
      maker.add(made_velodyne(0.1 * i, 20));
    }
  }
  expect_graceful(folder / "a.rawlog", [&] { read_recording(folder / "a.rawlog"); });
  const std::string name = (folder / "a.rawlog").string();
  ASSERT_EQ(std::system(("gzip -dc '" + name + "' > '" + name + ".plain'").c_str()), 0);
  expect_graceful(name + ".plain", [&] { read_recording(name + ".plain"); });
}

TEST(DamagedFiles, TextBesideKittiScans) {
  const TemporaryFolder folder;
  make_kitti_folder(folder.path(), 3);
  files::write_text(folder / "calib.txt", "Tr: 0 -1 0 0.1 0 0 -1 0.2 1 0 0 0.3\n");
  files::write_text(folder / "poses.txt",
                    "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 1 0 1 0 0 0 0 1 0\n1 0 0 2 0 1 0 0 0 0 1 0\n");
  files::write_text(folder / "traverse.yaml",
                    "name: a\nmotion_compensated: false\nsensor: hdl64e_kitti\n"
                    "lidar: {rings: 64, elevations_deg: [1, 2]}\nfirst_stamp: 12.5\n");
  for (const char* file : {"times.txt", "calib.txt", "poses.txt", "traverse.yaml"}) {
    expect_graceful(folder / file, [&] { read_recording(folder.path()); });
  }
}

}  // namespace
}  // namespace traverse::dataset
