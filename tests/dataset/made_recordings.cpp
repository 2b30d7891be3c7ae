#include "dataset/made_recordings.hpp"

#include <cmath>
#include <fstream>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"

#include "test_data.hpp"

namespace traverse::testing {

namespace fs = std::filesystem;
using dataset::Fact;

sensors::LidarScan made_scan(std::size_t rings, std::size_t points_a_ring, double seed) {
  sensors::LidarScan scan;
  for (std::size_t ring = 0; ring < rings; ++ring) {
    const double elevation = 0.03 - 0.007 * static_cast<double>(ring);
    for (std::size_t i = 0; i < points_a_ring; ++i) {
      const double azimuth = 2 * std::numbers::pi * (static_cast<double>(i) + 0.5) /
                             static_cast<double>(points_a_ring);
      const double range = 10 + 3 * std::sin(3 * azimuth + seed) + 0.1 * static_cast<double>(ring);
      scan.x.push_back(static_cast<float>(range * std::cos(elevation) * std::cos(azimuth)));
      scan.y.push_back(static_cast<float>(range * std::cos(elevation) * std::sin(azimuth)));
      scan.z.push_back(static_cast<float>(range * std::sin(elevation)));
      scan.intensity.push_back(static_cast<float>(i % 100) / 100);
    }
  }
  return scan;
}

void write_bin(const fs::path& file, const sensors::LidarScan& scan) {
  std::ofstream stream(file, std::ios::binary);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    for (const float value : {scan.x[i], scan.y[i], scan.z[i], scan.intensity[i]}) {
      stream.write(reinterpret_cast<const char*>(&value), sizeof value);
    }
  }
}

std::string bin_name(std::size_t number) { return fmt::format("velodyne/{:06d}.bin", number); }

void make_kitti_folder(const fs::path& folder, std::size_t scans) {
  fs::create_directories(folder / "velodyne");
  std::string times;
  for (std::size_t i = 0; i < scans; ++i) {
    write_bin(folder / bin_name(i), made_scan(4, 50, 0.1 * static_cast<double>(i)));
    times += fmt::format("{:.6e}\n", 0.1 * static_cast<double>(i));
  }
  files::write_text(folder / "times.txt", times);
}

OpenOptions options_with(std::vector<std::string> statements) {
  OpenOptions options;
  options.share_folder = TRAVERSE_SHARE_DIR;
  options.statements = std::move(statements);
  return options;
}

std::unique_ptr<Source> open(const fs::path& path, std::vector<std::string> statements) {
  return dataset::open_recording(path, options_with(std::move(statements)));
}

std::vector<sensors::Measurement> read_all(Source& source) {
  std::vector<sensors::Measurement> measurements;
  while (auto measurement = source.next()) measurements.push_back(std::move(*measurement));
  return measurements;
}

std::vector<ScanPtr> scans_in(const std::vector<sensors::Measurement>& measurements) {
  std::vector<ScanPtr> scans;
  for (const auto& measurement : measurements) {
    if (const auto* scan = std::get_if<ScanPtr>(&measurement)) scans.push_back(*scan);
  }
  return scans;
}

std::vector<ScanPtr> read_scans(Source& source) { return scans_in(read_all(source)); }

std::vector<std::int64_t> milliseconds_of(const std::vector<ScanPtr>& scans) {
  std::vector<std::int64_t> milliseconds;
  for (const auto& scan : scans) milliseconds.push_back(scan->stamp.nanoseconds / 1'000'000);
  return milliseconds;
}

std::string fact_value(const Source& source, const std::string& name) {
  for (const Fact& fact : source.info().facts) {
    if (fact.name == name) return fact.value;
  }
  return {};
}

std::string fact_reason(const Source& source, const std::string& name) {
  for (const Fact& fact : source.info().facts) {
    if (fact.name == name) return fact.reason;
  }
  return {};
}

std::vector<std::string> skipped_in(const Source& source) {
  std::vector<std::string> lines;
  for (const auto& [reason, count] : source.skipped().by_reason()) {
    lines.push_back(fmt::format("{} x {}", count.count, reason));
  }
  return lines;
}

std::string opening_error(const fs::path& path, std::vector<std::string> statements) {
  try {
    open(path, std::move(statements));
  } catch (const files::InputError& error) {
    return error.what();
  }
  return "no error";
}

bool copy_real_drive(const std::string& name, std::size_t scans, const fs::path& folder) {
  const fs::path drive = kitti_drive(name);
  if (!fs::is_directory(drive)) return false;
  fs::create_directories(folder / "velodyne");
  for (const auto& entry : fs::directory_iterator(drive)) {
    if (entry.is_regular_file()) fs::copy_file(entry, folder / entry.path().filename());
  }
  for (std::size_t i = 0; i < scans; ++i) {
    fs::copy_file(drive / bin_name(i), folder / bin_name(i));
  }
  return true;
}

}  // namespace traverse::testing
