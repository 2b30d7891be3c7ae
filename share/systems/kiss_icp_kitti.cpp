// KISS-ICP's own odometry on the scans of a folder in KITTI's layout, for the recipe kiss-icp.yaml:
//
//   kiss_icp_kitti FOLDER THREADS poses.txt
//
// Reads FOLDER/velodyne/*.bin (float32 x y z intensity) and writes one pose for each, of the lidar,
// the first being the identity, as twelve numbers. Settings are those of KISS-ICP as it comes but
// for `deskew`: these files have no times of points.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <vector>

#include "kiss_icp/pipeline/KissICP.hpp"

namespace fs = std::filesystem;

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: %s FOLDER THREADS poses.txt\n", argv[0]);
    return 2;
  }
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(argv[1]) / "velodyne")) {
    if (entry.path().extension() == ".bin") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  kiss_icp::pipeline::KISSConfig config;
  config.deskew = false;
  config.max_num_threads = std::atoi(argv[2]);
  kiss_icp::pipeline::KissICP odometry(config);
  std::ofstream poses(argv[3]);
  poses.precision(10);
  for (const fs::path& file : files) {
    std::vector<float> raw(fs::file_size(file) / sizeof(float));
    std::ifstream(file, std::ios::binary)
        .read(reinterpret_cast<char*>(raw.data()),
              static_cast<std::streamsize>(raw.size() * sizeof(float)));
    std::vector<Eigen::Vector3d> points;
    for (std::size_t i = 0; i + 3 < raw.size(); i += 4) {
      points.emplace_back(raw[i], raw[i + 1], raw[i + 2]);
    }
    odometry.RegisterFrame(points, {});
    const Eigen::Matrix4d pose = odometry.pose().matrix();
    for (int k = 0; k < 12; ++k) poses << pose(k / 4, k % 4) << (k < 11 ? ' ' : '\n');
  }
  poses.close();
  return poses ? 0 : 1;
}
