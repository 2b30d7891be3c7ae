#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/geodesy/local_tangent_plane.hpp"
#include "traverse/mapping/map_origin.hpp"

#include "end_to_end/program.hpp"
#include "temporary_folder.hpp"

namespace traverse {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::ProgramResult;
using testing::run_program;

/// Two runs of 35 m of a simulated street that overlap, made once.
class MapCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new testing::TemporaryFolder;
    const std::string rawlog = path("town.rawlog");
    const ProgramResult made =
        run_program("simulate town_loop --sensor vlp16 --first 100 --duration 4 -o " + rawlog);
    ASSERT_EQ(made.status, 0) << made.messages;
    const std::string run = "run " + rawlog + " --no-report ";
    const ProgramResult first = run_program(run + "--las --last 29 -o " + path("run1"));
    ASSERT_EQ(first.status, 0) << first.messages;
    const ProgramResult second = run_program(run + "--first 8 -o " + path("run2"));
    ASSERT_EQ(second.status, 0) << second.messages;
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::string path(const std::string& name) { return (*folder_ / name).string(); }

  static testing::TemporaryFolder* folder_;
};

testing::TemporaryFolder* MapCommand::folder_ = nullptr;

/// Points of one keyframe were seen by all sixteen rings within a sweep of a tenth of a second.
void expect_point_attributes(const dataset::PointCloud& cloud) {
  for (const char* field : {"time", "ring", "keyframe"}) {
    ASSERT_NE(cloud.find(field), nullptr) << field;
  }
  const std::vector<double> time = dataset::to_doubles(*cloud.find("time"));
  const std::vector<double> ring = dataset::to_doubles(*cloud.find("ring"));
  const std::vector<double> keyframe = dataset::to_doubles(*cloud.find("keyframe"));
  std::set<double> rings;
  double earliest = time.front();
  double latest = time.front();
  for (std::size_t i = 0; i < time.size() && keyframe[i] == keyframe.front(); ++i) {
    rings.insert(ring[i]);
    earliest = std::min(earliest, time[i]);
    latest = std::max(latest, time[i]);
  }
  EXPECT_EQ(rings.size(), 16U);
  EXPECT_EQ(*rings.rbegin(), 15);
  EXPECT_GT(latest - earliest, 0.05);
  EXPECT_LT(latest - earliest, 0.11);
}

TEST_F(MapCommand, MakesPointsAndGridOfARun) {
  const ProgramResult result =
      run_program("map " + path("run1") + " --attributes -o " + path("map"));
  ASSERT_EQ(result.status, 0) << result.messages;
  EXPECT_THAT(result.messages, HasSubstr("moving objects"));
  for (const char* file : {"map.ply", "map.simplemap", "grid.png", "grid.yaml"}) {
    EXPECT_TRUE(fs::is_regular_file(fs::path(path("map")) / file)) << file;
  }
  const auto cloud = dataset::read_point_cloud(path("map") + "/map.ply");
  EXPECT_GT(cloud.size(), 1000U);
  EXPECT_NE(cloud.find("intensity"), nullptr);
  expect_point_attributes(cloud);
  const ProgramResult again = run_program("map " + path("map/map.simplemap") +
                                          " --attributes --no-grid -o " + path("again"));
  EXPECT_EQ(again.status, 0) << again.messages;
  EXPECT_FALSE(fs::exists(path("again/grid.png")));
  expect_point_attributes(dataset::read_point_cloud(path("again") + "/map.ply"));
}

TEST_F(MapCommand, MergesRunsThatOverlap) {
  const ProgramResult result =
      run_program("map " + path("run1") + " " + path("run2") +
                  " --attributes --set grid.cell_m=0.2 --set merge.samples=8 -o " + path("merged"));
  ASSERT_EQ(result.status, 0) << result.messages;
  expect_point_attributes(dataset::read_point_cloud(path("merged") + "/map.ply"));
  EXPECT_THAT(result.output, HasSubstr("2 runs brought together"));
}

/// What tests/readers/list_las.mjs prints, as words; none where node or its packages are not there.
std::vector<std::string> words_of_other_readers(const std::string& las) {
  const std::string readers = TRAVERSE_TEST_READERS;
  const std::string output = las + ".txt";
  std::vector<std::string> words;
  if (!fs::exists(fs::path(readers) / "node_modules/copc")) return words;
  const std::string command = "node " + readers + "/list_las.mjs " + las + " > " + output;
  if (std::system(command.c_str()) != 0) return words;
  std::istringstream text(files::read_text(output));
  for (std::string word; text >> word;) words.push_back(word);
  return words;
}

TEST_F(MapCommand, ExportSaysWhatAFolderWithoutPointsIs) {
  fs::create_directory(path("empty"));
  const ProgramResult result = run_program("export " + path("empty") + " " + path("x.las"));
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.messages, HasSubstr("expected the points of a run with a lidar or of a map"));
}

TEST_F(MapCommand, ARunWritesItsPointsAsLasToo) {
  constexpr std::uintmax_t kPointBytes = 30;
  const std::uintmax_t points = dataset::read_point_cloud(path("run1/map.ply")).size();
  const std::uintmax_t bytes = fs::file_size(path("run1/map.las"));
  EXPECT_GT(bytes, points * kPointBytes + 375);
  EXPECT_LT(bytes, points * kPointBytes + 3000);
}

TEST_F(MapCommand, OtherReadersFindThePointsOfALasFileAtTheirPlaceOnEarth) {
  const ProgramResult result =
      run_program("map " + path("run1") + " --las --no-grid -o " + path("las"));
  ASSERT_EQ(result.status, 0) << result.messages;
  EXPECT_THAT(result.output,
              HasSubstr("map.las: WGS 84 / UTM zone 32N, heights above the ellipsoid"));
  EXPECT_THAT(result.output, HasSubstr("adjusted standard GPS time"));
  const std::vector<std::string> words = words_of_other_readers(path("las/map.las"));
  if (words.empty()) {
    GTEST_SKIP() << "node with copc and @loaders.gl/las is not there; `scripts/dependencies test` "
                    "installs them where npm is";
  }
  const ProgramResult exported = run_program("export " + path("las") + " " + path("again.las"));
  ASSERT_EQ(exported.status, 0) << exported.messages;
  EXPECT_THAT(exported.output, HasSubstr("UTM zone 32N, heights above the ellipsoid, no times"));
  const auto cloud = dataset::read_point_cloud(path("las/map.ply"));
  EXPECT_EQ(words_of_other_readers(path("again.las"))[1], words[1]);
  EXPECT_EQ(words[0], "copc");
  EXPECT_EQ(words[1], std::to_string(cloud.size()));
  // The last point, by another way than the program's: geodetic coordinates, then the projection.
  const geodesy::LocalTangentPlane plane(mapping::read_map_origin(path("las/origin.json")));
  Eigen::Vector3d enu;
  int axis = 0;
  for (const char* field : {"x", "y", "z"}) {
    enu[axis++] = dataset::to_doubles(*cloud.find(field)).back();
  }
  const geodesy::Utm utm = geodesy::to_utm(plane.to_geodetic(enu));
  const std::size_t n = words.size();
  EXPECT_EQ(words[n - 8], "laz-rs");
  EXPECT_EQ(words[n - 7], std::to_string(cloud.size()));
  EXPECT_NEAR(std::stod(words[n - 3]), utm.easting_m, 0.001);
  EXPECT_NEAR(std::stod(words[n - 2]), utm.northing_m, 0.001);
  EXPECT_NEAR(std::stod(words[n - 1]), utm.altitude_m, 0.001);
}

TEST_F(MapCommand, SaysWhatIsWrong) {
  EXPECT_EQ(run_program("map " + path("none") + " -o " + path("x")).status, 2);
  EXPECT_EQ(run_program("map " + path("run1")).status, 2);
  const ProgramResult unknown =
      run_program("map " + path("run1") + " --set voxel=1 -o " + path("x"));
  EXPECT_EQ(unknown.status, 1);
  EXPECT_THAT(unknown.messages, HasSubstr("did you mean 'voxel_m'?"));
  const ProgramResult no_map = run_program("map " + path("town.rawlog") + " -o " + path("x"));
  EXPECT_EQ(no_map.status, 1);
  EXPECT_THAT(no_map.messages, HasSubstr("town.rawlog: expected a simple map"));
}

TEST_F(MapCommand, ListsItsSettings) {
  const ProgramResult result = run_program("map --settings");
  EXPECT_EQ(result.status, 0) << result.messages;
  for (const char* key : {"voxel_m", "free_space.min_votes", "grid.cell_m", "merge.samples"}) {
    EXPECT_THAT(result.output, HasSubstr(key));
  }
}

}  // namespace
}  // namespace traverse
