// Milliseconds of each stage of each lidar odometry, with the calibration of the machine beside
// them.
//
//   odometry_bench                     the 100 scans of KITTI drive 0005 when they are there (see
//                                      tests/test_data.hpp), else a simulated street
//
// "frame" and the stages are medians over the frames, start-up frames left out; reading is not
// measured. "scaled" is the frame's median on the machine of the published comparison, on which
// the calibration (a static nanoflann tree over 500,000 random points) takes 86 ms. "cpu" is the
// median of the processor time of a frame, of all threads together: on a machine that others use
// too it is the figure to compare.

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <functional>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <nanoflann.hpp>

#include "traverse/dataset/open_recording.hpp"
#include "traverse/loam/scan_to_map_odometry.hpp"
#include "traverse/voxel_map/voxel_map_odometry.hpp"

#include "lidar/simulated_drive.hpp"
#include "test_data.hpp"

namespace traverse {
namespace {

constexpr double kPublishedCalibrationMs = 86;
constexpr std::size_t kStartFrames = 12;  // with more registration steps than later ones

struct RandomCloud {
  std::vector<float> xyz;

  std::size_t kdtree_get_point_count() const { return xyz.size() / 3; }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const { return xyz[3 * i + axis]; }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

double calibration_ms() {
  RandomCloud cloud;
  std::mt19937 generator(1);
  std::uniform_real_distribution<float> coordinate(-50, 50);
  cloud.xyz.resize(1'500'000);
  for (float& value : cloud.xyz) value = coordinate(generator);
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, RandomCloud>,
                                                   RandomCloud, 3, std::uint32_t>;
  double best = 1e9;
  for (int repeat = 0; repeat < 5; ++repeat) {
    const auto begin = std::chrono::steady_clock::now();
    const Tree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(20));
    const auto end = std::chrono::steady_clock::now();
    best = std::min(best, std::chrono::duration<double, std::milli>(end - begin).count());
  }
  return best;
}

struct Recording {
  std::string name;
  sensors::LidarProfile profile;
  std::vector<sensors::LidarScan> scans;
};

Recording load_recording() {
  const auto drive = testing::kitti_drive("2011_09_26_drive_0005");
  if (!std::filesystem::is_directory(drive)) {
    testing::SimulatedDrive street(simulation::street(100, 1), 60, 12);
    return {"simulated street", street.scanner.profile, street.scans};
  }
  dataset::OpenOptions options;
  options.share_folder = TRAVERSE_SHARE_DIR;
  options.statements_file =
      std::filesystem::path(TRAVERSE_SHARE_DIR) / "recordings/kitti_raw_drive.yaml";
  const auto source = dataset::open_recording(drive, options);
  Recording recording{"KITTI drive 0005", *source->info().rig.sensors.front().lidar, {}};
  while (const auto measurement = source->next()) {
    if (const auto* scan = std::get_if<std::shared_ptr<const sensors::LidarScan>>(&*measurement)) {
      recording.scans.push_back(**scan);
    }
  }
  return recording;
}

/// Of the values after the start.
double median(std::vector<double> values) {
  const std::size_t skipped = std::min(kStartFrames, values.size() / 2);
  values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(skipped));
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double median_of(const std::vector<lidar::Frame>& frames,
                 const std::function<double(const lidar::StageTimes&)>& stage) {
  std::vector<double> values;
  std::transform(frames.begin(), frames.end(), std::back_inserter(values),
                 [&](const lidar::Frame& f) { return stage(f.ms); });
  return median(std::move(values));
}

/// Processor time of all threads of the program.
double cpu_ms() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

template <typename Odometry, typename Options>
void odometry(benchmark::State& state) {
  static const Recording recording = load_recording();
  static const double calibration = calibration_ms();
  Options options;
  options.threads = static_cast<int>(state.range(0));
  std::vector<lidar::Frame> frames;
  std::vector<double> cpu;  // ms of a scan
  for (auto _ : state) {
    Odometry algorithm(options, recording.profile, false);
    frames.clear();
    cpu.clear();
    for (const auto& scan : recording.scans) {
      const double begin = cpu_ms();
      for (lidar::Frame& frame : algorithm.process(scan)) frames.push_back(std::move(frame));
      cpu.push_back(cpu_ms() - begin);
    }
  }
  using Times = lidar::StageTimes;
  const double frame = median_of(frames, [](const Times& t) { return t.total(); });
  state.SetLabel(recording.name);
  state.counters["frame_ms"] = frame;
  state.counters["cpu_ms"] = median(std::move(cpu));
  state.counters["calibration_ms"] = calibration;
  state.counters["scaled_ms"] = frame * kPublishedCalibrationMs / calibration;
  state.counters["organise_ms"] = median_of(frames, [](const Times& t) { return t.organise; });
  state.counters["features_ms"] = median_of(frames, [](const Times& t) { return t.features; });
  state.counters["deskew_ms"] = median_of(frames, [](const Times& t) { return t.deskew; });
  state.counters["index_ms"] = median_of(frames, [](const Times& t) { return t.index; });
  state.counters["associate_ms"] = median_of(frames, [](const Times& t) { return t.associate; });
  state.counters["solve_ms"] = median_of(frames, [](const Times& t) { return t.solve; });
  state.counters["insert_ms"] = median_of(frames, [](const Times& t) { return t.insert; });
}

void per_thread(benchmark::internal::Benchmark* bench) {
  bench->ArgName("threads")->Arg(1)->Arg(2)->Arg(4)->Iterations(1)->Repetitions(3);
  bench->Unit(benchmark::kMillisecond)->DisplayAggregatesOnly(true);
}

void floam(benchmark::State& state) {
  odometry<loam::ScanToMapOdometry, loam::ScanToMapOdometryOptions>(state);
}
void traverse_preset(benchmark::State& state) {
  odometry<voxel_map::VoxelMapOdometry, voxel_map::VoxelMapOdometryOptions>(state);
}
BENCHMARK(floam)->Apply(per_thread);
BENCHMARK(traverse_preset)->Name("traverse")->Apply(per_thread);

}  // namespace
}  // namespace traverse

BENCHMARK_MAIN();
