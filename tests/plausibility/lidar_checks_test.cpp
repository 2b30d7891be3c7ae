#include <bit>
#include <cstring>
#include <limits>
#include <memory>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "plausibility/made_recording.hpp"

namespace traverse::plausibility {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using namespace traverse::testing;  // made recordings
using sensors::LidarScan;

/// A scan from the middle of a hall of 40 x 14 x 5 m, ring after ring as KITTI stores them or, by
/// columns, in firing order.
LidarScan hall_scan(std::size_t number, bool by_columns) {
  constexpr int kRings = 16;
  constexpr int kColumns = 360;
  std::mt19937 generator(static_cast<std::uint32_t>(number));
  std::normal_distribution<float> noise(0, 0.02F);
  LidarScan scan;
  scan.sensor = "lidar";
  scan.stamp = geometry::Stamp::from_seconds(100 + 0.1 * static_cast<double>(number));
  for (int k = 0; k < kRings * kColumns; ++k) {
    const int ring = by_columns ? k % kRings : k / kColumns;
    const int column = by_columns ? k / kRings : k % kColumns;
    const double azimuth = 2 * M_PI * column / kColumns;
    const double elevation = (2 * ring - 15) * M_PI / 180;
    const Eigen::Vector3d d(std::cos(elevation) * std::cos(azimuth),
                            std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
    const Eigen::Vector3d to_wall(20 / std::abs(d.x()), 7 / std::abs(d.y()),
                                  (d.z() > 0 ? 3.2 : 1.8) / std::abs(d.z()));
    const Eigen::Vector3f p = (to_wall.minCoeff() * d).cast<float>();
    scan.x.push_back(p.x() + noise(generator));
    scan.y.push_back(p.y() + noise(generator));
    scan.z.push_back(p.z() + noise(generator));
    scan.intensity.push_back(0.3F + noise(generator));
    scan.time.push_back(0.1F * static_cast<float>(column) / kColumns);
  }
  return scan;
}

template <typename Change>
MadeRecording recording_of(const Change& change, bool by_columns = false, std::size_t scans = 20) {
  MadeRecording recording;
  recording.info.format = "KITTI odometry";
  recording.info.rig.sensors.push_back(
      {"lidar", sensors::SensorKind::kLidar, {}, sensors::LidarProfile()});
  for (std::size_t i = 0; i < scans; ++i) {
    LidarScan scan = hall_scan(i, by_columns);
    change(scan);
    recording.measurements.emplace_back(std::make_shared<const LidarScan>(std::move(scan)));
  }
  return recording;
}

void scale(LidarScan& scan, float factor) {
  for (auto* values : {&scan.x, &scan.y, &scan.z}) {
    for (float& value : *values) value *= factor;
  }
}

/// The scan as it is read when its points have `columns` numbers of type Number instead of 4
/// floats.
template <typename Number>
LidarScan misread(const LidarScan& scan, std::size_t columns) {
  std::vector<std::byte> bytes;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    for (std::size_t k = 0; k < columns; ++k) {
      const auto value = static_cast<Number>(k == 0   ? scan.x[i]
                                             : k == 1 ? scan.y[i]
                                             : k == 2 ? scan.z[i]
                                             : k == 3 ? scan.intensity[i]
                                                      : static_cast<float>(i % 16));
      // What a file of doubles holds was not rounded to a float.
      const Number stored = std::is_same_v<Number, double>
                                ? static_cast<Number>(static_cast<double>(value) * (1 + 1e-9))
                                : value;
      const auto* begin = reinterpret_cast<const std::byte*>(&stored);
      bytes.insert(bytes.end(), begin, begin + sizeof stored);
    }
  }
  LidarScan read = scan;
  const std::size_t points = bytes.size() / 16;
  for (auto* values : {&read.x, &read.y, &read.z, &read.intensity}) values->resize(points);
  read.time.clear();
  for (std::size_t i = 0; i < points; ++i) {
    std::array<float, 4> p;
    std::memcpy(p.data(), bytes.data() + 16 * i, 16);
    read.x[i] = p[0];
    read.y[i] = p[1];
    read.z[i] = p[2];
    read.intensity[i] = p[3];
  }
  return read;
}

TEST(LidarChecks, SayNothingOfScansThatAreRight) {
  for (const bool by_columns : {false, true}) {
    const auto findings = findings_in(recording_of([](LidarScan&) {}, by_columns));
    EXPECT_THAT(findings, IsEmpty()) << texts_of(findings);
  }
  // Without times, without intensity, half of the points missing, every tenth scan kept.
  EXPECT_THAT(findings_in(recording_of([](LidarScan& s) { s.time.clear(); })), IsEmpty());
  EXPECT_THAT(findings_in(recording_of([](LidarScan& s) { s.intensity.clear(); })), IsEmpty());
  EXPECT_THAT(findings_in(recording_of([](LidarScan& s) {
                for (std::size_t i = 0; i < s.size(); i += 2) {
                  s.x[i] = s.y[i] = s.z[i] = std::numeric_limits<float>::quiet_NaN();
                }
              })),
              IsEmpty());
  EXPECT_THAT(findings_in(recording_of([](LidarScan& s) {
                s.stamp = geometry::shifted(s.stamp, 9 * s.stamp.seconds());
              })),
              IsEmpty());
}

TEST(LidarChecks, PointsInNoOrderHaveAnyNumberOfColumns) {
  EXPECT_THAT(findings_in(recording_of([](LidarScan& s) {
                std::mt19937 generator(5);
                for (std::size_t i = s.size() - 1; i > 0; --i) {
                  const std::size_t j = generator() % (i + 1);
                  for (auto* values : {&s.x, &s.y, &s.z, &s.intensity, &s.time}) {
                    std::swap((*values)[i], (*values)[j]);
                  }
                }
              })),
              IsEmpty());
}

TEST(LidarChecks, UnitsOfLength) {
  const auto millimetres = findings_in(recording_of([](LidarScan& s) { scale(s, 1000); }));
  ASSERT_THAT(codes_of(millimetres), ElementsAre("points_in_millimetres")) << texts_of(millimetres);
  EXPECT_THAT(millimetres.front().statement, HasSubstr("point_unit_m=0.001"));
  const auto kilometres = findings_in(recording_of([](LidarScan& s) { scale(s, 1e-3F); }));
  ASSERT_THAT(codes_of(kilometres), ElementsAre("points_out_of_range")) << texts_of(kilometres);
  EXPECT_EQ(kilometres.front().severity, Severity::kRefuse);
}

TEST(LidarChecks, CoordinatesOfAMapAreNoScan) {
  for (const auto& [east, north] : {std::pair{691000.F, 5334000.F}, {4200.F, -800.F}}) {
    const auto findings = findings_in(recording_of([x_m = east, y_m = north](LidarScan& s) {
      for (float& x : s.x) x += x_m;
      for (float& y : s.y) y += y_m;
    }));
    ASSERT_THAT(codes_of(findings), ElementsAre("points_far_away")) << texts_of(findings);
  }
}

TEST(LidarChecks, ColumnsOfABinFile) {
  for (const bool by_columns : {false, true}) {
    for (const std::size_t columns : {3U, 5U, 6U}) {
      const auto findings = findings_in(
          recording_of([&](LidarScan& s) { s = misread<float>(s, columns); }, by_columns));
      ASSERT_THAT(codes_of(findings), ElementsAre("points_columns")) << texts_of(findings);
      EXPECT_EQ(findings.front().statement, "--recording bin.columns=" + std::to_string(columns));
    }
    const auto doubles =
        findings_in(recording_of([](LidarScan& s) { s = misread<double>(s, 4); }, by_columns));
    ASSERT_THAT(codes_of(doubles), ElementsAre("points_absurd")) << texts_of(doubles);
    EXPECT_THAT(doubles.front().statement, HasSubstr("bin.type=float64"));
  }
}

TEST(LidarChecks, AnEmptyScanIsSaid) {
  const auto findings = findings_in(recording_of([](LidarScan& s) {
    for (std::size_t i = 0; i < s.size(); ++i) {
      if (i % 40 != 0) s.x[i] = s.y[i] = s.z[i] = 0;
    }
  }));
  EXPECT_THAT(codes_of(findings), ElementsAre("points_missing")) << texts_of(findings);
}

TEST(LidarChecks, SpanOfPointTimes) {
  const auto with_times = [](float factor) {
    return findings_in(recording_of([&](LidarScan& s) {
      for (float& time : s.time) time *= factor;
    }));
  };
  for (const float factor : {1e-3F, 1e-6F}) {
    const auto findings = with_times(factor);
    ASSERT_THAT(codes_of(findings), ElementsAre("point_times_short")) << texts_of(findings);
    EXPECT_EQ(findings.front().severity, Severity::kWarn);
  }
  for (const float factor : {3.F, 1e3F, 1e6F}) {
    const auto findings = with_times(factor);
    ASSERT_THAT(codes_of(findings), ElementsAre("point_times_long")) << texts_of(findings);
    EXPECT_EQ(findings.front().severity, factor > 10 ? Severity::kRefuse : Severity::kWarn);
  }
  EXPECT_THAT(with_times(-1), IsEmpty());  // stamps at the end
  EXPECT_THAT(with_times(0.1F), IsEmpty());
}

TEST(LidarChecks, AScanWhosePointsHaveOneTime) {
  int number = 0;
  const auto findings = findings_in(recording_of([&](LidarScan& s) {
    if (++number == 7) std::fill(s.time.begin(), s.time.end(), 0.F);
  }));
  EXPECT_THAT(codes_of(findings), ElementsAre("point_times_equal")) << texts_of(findings);
  // Where all of them have, the times are no times: nothing contradicts anything.
  EXPECT_THAT(
      findings_in(recording_of([](LidarScan& s) { std::fill(s.time.begin(), s.time.end(), 0.F); })),
      IsEmpty());
}

}  // namespace
}  // namespace traverse::plausibility
