#include "navigation_log/navigation_log.hpp"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"
#include "traverse/files/numbers.hpp"
#include "traverse/files/text_encoding.hpp"
#include "traverse/files/text_file.hpp"

#include "recording/folder_opening.hpp"
#include "recording/listed_source.hpp"
#include "recording/unused_files.hpp"

namespace traverse::dataset {

using files::InputError;
using files::Place;
using sensors::GnssFix;
using sensors::ImuSample;
using sensors::SensorKind;
using sensors::WheelOdometry;

namespace {

namespace fs = std::filesystem;

constexpr const char* kImuLine = "IMU";
constexpr const char* kWheelLine = "ODOM";
constexpr const char* kGnssLine = "GNSS";
constexpr std::size_t kMostWords = 9;  // one more than a line can have
constexpr std::int64_t kMostTicks = std::int64_t{1} << 60;

/// Why a line is not used, to be counted with others of its kind.
class BadLine : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A time that is out of range, as it stands in the line.
class NoSuchTime : public BadLine {
 public:
  NoSuchTime(const std::string& fault, std::string_view time) : BadLine(fault), time_(time) {}
  const std::string& time() const { return time_; }

 private:
  std::string time_;
};

class LineParser {
 public:
  LineParser(const LogStatements& log, const ImuStatements& imu, const GnssStatements& gnss)
      : log_(log), stated_(imu, gnss) {}

  sensors::Measurement parse(std::string_view line) {
    const std::vector<std::string_view> words = files::split_words(line, kMostWords);
    if (words.size() > 1) time_ = words[1];
    if (words[0] == kImuLine) return imu(numbers(words, 7));
    if (words[0] == kWheelLine) return wheels(numbers(words, 3));
    if (words[0] == kGnssLine) return gnss(numbers(words, 6));
    throw BadLine("a line that does not begin with IMU, ODOM or GNSS");
  }

 private:
  static std::vector<double> numbers(const std::vector<std::string_view>& words,
                                     std::size_t count) {
    const std::string kind(words[0]);
    if (words.size() != count + 1) {
      throw BadLine(fmt::format("{} line with not {} numbers", kind, count));
    }
    std::vector<double> values;
    for (std::size_t i = 1; i < words.size(); ++i) {
      const auto value = files::parse_double(words[i]);
      if (!value) throw BadLine(kind + " line with a word that is no number");
      if (!std::isfinite(*value)) throw BadLine(kind + " line with a number that is not finite");
      values.push_back(*value);
    }
    return values;
  }

  geometry::Stamp stamp(double time, const char* kind) const {
    constexpr double kLatest = 9e9;  // seconds that whole nanoseconds can hold
    const double seconds = time * log_.time_unit_s;
    if (std::abs(seconds) > kLatest) {
      throw NoSuchTime(std::string(kind) + " line with no such time", time_);
    }
    return geometry::Stamp::from_seconds(seconds);
  }

  ImuSample imu(const std::vector<double>& v) {
    const double unit = log_.angular_rate == AngularUnit::kDegrees ? std::numbers::pi / 180 : 1;
    ImuSample sample{stamp(v[0], kImuLine), kImuLine, unit * Eigen::Vector3d(v[1], v[2], v[3]),
                     Eigen::Vector3d(v[4], v[5], v[6])};
    if (!stated_.apply(sample)) throw BadLine("IMU line of increments with no line before it");
    return sample;
  }

  WheelOdometry wheels(const std::vector<double>& v) {
    constexpr double kMost = 1e15;
    if (std::abs(v[1]) > kMost || std::abs(v[2]) > kMost)
      throw BadLine("ODOM line with no such count");
    const WheelOdometry::Ticks told{std::llround(v[1]), std::llround(v[2])};
    WheelOdometry reading;
    reading.stamp = stamp(v[0], kWheelLine);
    reading.sensor = kWheelLine;
    if (log_.pulses == PulseCount::kCumulative) {
      reading.ticks = told;
    } else {
      if (std::abs(ticks_.left) > kMostTicks || std::abs(ticks_.right) > kMostTicks) {
        throw BadLine("ODOM line after more pulses than can be counted");
      }
      ticks_ = {ticks_.left + told.left, ticks_.right + told.right};
      reading.ticks = ticks_;
    }
    return reading;
  }

  GnssFix gnss(const std::vector<double>& v) const {
    if (v[5] != 0 && v[5] != 1) throw BadLine("GNSS line whose heading_valid is not 0 or 1");
    GnssFix fix;
    fix.stamp = stamp(v[0], kGnssLine);
    fix.sensor = kGnssLine;
    fix.latitude_deg = v[1];
    fix.longitude_deg = v[2];
    fix.altitude_m = v[3];
    if (v[5] == 1) fix.heading_deg = v[4];
    stated_.apply(fix);
    if (std::abs(fix.latitude_deg) > 90 || std::abs(fix.longitude_deg) > 360) {
      throw BadLine("GNSS line with no such place");
    }
    if (is_nowhere(fix)) throw BadLine(kNoFixYet);
    return fix;
  }

  LogStatements log_;
  std::string_view time_;  ///< of the line that is being read
  StatedMeasurements stated_;
  WheelOdometry::Ticks ticks_;
};

void mount(RecordingInfo& info, const Statements& statements, const ListedRecords& records) {
  for (const auto& stream : {std::pair{kImuLine, SensorKind::kImu},
                             {kGnssLine, SensorKind::kGnss},
                             {kWheelLine, SensorKind::kWheels}}) {
    if (!records.has(stream.first)) continue;
    info.rig.sensors.push_back(
        {stream.first, stream.second, geometry::Pose3::identity(), std::nullopt});
    apply_vehicle(statements, info.rig.sensors.back());
  }
}

}  // namespace

bool is_navigation_log(const fs::path& file) {
  constexpr std::size_t kLinesLookedAt = 20;
  files::LineReader reader(file);
  try {
    for (std::size_t i = 0; i < kLinesLookedAt && reader.next(); ++i) {
      const auto words = files::split_words(reader.line(), kMostWords);
      if (words.empty()) continue;
      if (words[0] == kImuLine || words[0] == kWheelLine || words[0] == kGnssLine) return true;
      if (words[0].size() > 100) return false;
    }
  } catch (const files::OtherEncoding&) {
    throw;  // a text, and no other reader would name it
  } catch (const InputError&) {
    return false;  // no line of a log is so long
  }
  return false;
}

std::unique_ptr<Source> open_navigation_log(const fs::path& file, const OpenOptions& options,
                                            std::string_view format) {
  const Statements statements(fs::path(file).replace_extension(".traverse.yaml"), options,
                              file.parent_path());
  RecordingInfo info = begin_info(file, format, statements, "vehicle");
  const auto unit = statements->log.angular_rate == AngularUnit::kDegrees ? "deg/s" : "rad/s";
  const auto pulses =
      statements->log.pulses == PulseCount::kCumulative ? "cumulative" : "of each interval";
  info.facts.push_back(
      {"angular rates", unit, statements.reason("log.angular_rate", "default, not stated")});
  info.facts.push_back({"pulses", pulses, statements.reason("log.pulses", "default, not stated")});

  ListedRecords records;
  LineParser parser(statements->log, statements->imu, statements->gnss);
  files::LineReader reader(file);
  std::size_t used = 0;
  std::size_t out_of_range = 0;
  std::optional<InputError> first_out_of_range;
  while (reader.next()) {
    try {
      records.add(parser.parse(reader.line()), reader.number());
      ++used;
    } catch (const BadLine& bad) {
      records.skip(bad.what(), fmt::format("line {}", reader.number()));
      const auto* time = dynamic_cast<const NoSuchTime*>(&bad);
      if (time != nullptr && ++out_of_range == 1) {
        first_out_of_range =
            reader.error(fmt::format("a time in seconds, since log.time_unit_s is {}",
                                     statements->log.time_unit_s),
                         time_out_of_range(time->time(), "log.time_unit_s"));
      }
    }
  }
  if (out_of_range > used) throw InputError(*first_out_of_range);
  mount(info, statements, records);
  if (info.rig.sensors.empty()) {
    throw InputError(file, Place::whole_file(), "lines of IMU, ODOM or GNSS that can be used",
                     records.first_fault().empty() ? "no line" : records.first_fault());
  }
  std::optional<Reference> reference;
  if (const auto stated = stated_reference(statements)) {
    reference = load_reference(*stated, {}, {}, info.facts);
  }
  note_unused_files(info, options, reference, 0);
  return make_listed_source(std::move(info), std::move(records), std::move(reference));
}

}  // namespace traverse::dataset
