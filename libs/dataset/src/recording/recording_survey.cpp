#include "traverse/dataset/recording_survey.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <utility>

#include "traverse/sensors/rings.hpp"
#include "traverse/statistics/quantile.hpp"

namespace traverse::dataset {

using geometry::Stamp;
using sensors::LidarProfile;
using sensors::LidarScan;
using sensors::SensorKind;

namespace {

constexpr double kGapFactor = 3;

Spread spread_of(std::vector<std::size_t> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  return {values.front(), values[values.size() / 2], values.back()};
}

/// Gathers the scans of one lidar.
class LidarTally {
 public:
  void add(const LidarScan& scan, const LidarProfile& profile) {
    if (points_.empty()) {
      survey_.has_intensity = !scan.intensity.empty();
      survey_.has_stored_times = !scan.time.empty();
      survey_.rings_expected = profile.rings;
    }
    TroubledScan trouble;
    trouble.frame = points_.size();
    trouble.stamp = scan.stamp;
    trouble.points = count_faults(scan);
    points_.push_back(scan.size());
    add_times(scan);
    add_rings(scan, profile, trouble);
    if (trouble.points.total() > 0 || trouble.points_beyond_rings > 0 || trouble.has_one_ring) {
      survey_.troubled.push_back(trouble);
    }
  }

  LidarSurvey finish() {
    survey_.points = spread_of(std::move(points_));
    if (!rings_.empty()) survey_.rings = spread_of(std::move(rings_));
    return std::move(survey_);
  }

 private:
  void add_times(const LidarScan& scan) {
    if (scan.time.empty()) return;
    const auto [least, most] = std::minmax_element(scan.time.begin(), scan.time.end());
    const bool is_first = points_.size() == 1;
    survey_.earliest_point_time_s =
        is_first ? *least : std::min(survey_.earliest_point_time_s, *least);
    survey_.latest_point_time_s = is_first ? *most : std::max(survey_.latest_point_time_s, *most);
  }

  void add_rings(const LidarScan& scan, const LidarProfile& profile, TroubledScan& trouble) {
    try {
      const sensors::RingAssignment rings = assign_rings(scan, profile);
      rings_.push_back(rings.ring_count);
      if (profile.rings > 0) {
        trouble.points_beyond_rings = static_cast<std::size_t>(
            std::count_if(rings.ring.begin(), rings.ring.end(),
                          [&](std::uint16_t ring) { return ring >= profile.rings; }));
      }
      trouble.has_one_ring =
          profile.rings != 1 && std::adjacent_find(rings.ring.begin(), rings.ring.end(),
                                                   std::not_equal_to<>()) == rings.ring.end();
    } catch (const sensors::NoRings& error) {
      survey_.why_no_rings = error.what();
    }
  }

  LidarSurvey survey_;
  std::vector<std::size_t> points_;
  std::vector<std::size_t> rings_;
};

/// Gathers the measurements of one sensor.
struct StreamTally {
  std::string sensor;
  SensorKind kind;
  std::vector<Stamp> stamps;
  std::unique_ptr<LidarTally> lidar;

  StreamSurvey finish() const {
    StreamSurvey survey;
    survey.sensor = sensor;
    survey.kind = kind;
    survey.count = stamps.size();
    survey.first = stamps.front();
    survey.last = stamps.back();
    std::vector<double> intervals;
    for (std::size_t i = 1; i < stamps.size(); ++i) {
      intervals.push_back(seconds_between(stamps[i - 1], stamps[i]));
    }
    if (!intervals.empty()) {
      survey.median_interval_s = statistics::median(intervals);
    }
    for (std::size_t i = 0; i < intervals.size(); ++i) {
      if (intervals[i] > kGapFactor * survey.median_interval_s) {
        survey.gaps.push_back({stamps[i], intervals[i]});
      }
    }
    if (lidar) survey.lidar = lidar->finish();
    return survey;
  }
};

SensorKind kind_of(const sensors::Measurement& measurement) {
  constexpr std::array<SensorKind, 5> kKinds{SensorKind::kLidar, SensorKind::kPlanarLaser,
                                             SensorKind::kImu, SensorKind::kGnss,
                                             SensorKind::kWheels};
  static_assert(std::variant_size_v<sensors::Measurement> == kKinds.size());
  return kKinds.at(measurement.index());
}

void add(StreamTally& tally, const sensors::Measurement& measurement, const sensors::Rig& rig) {
  tally.stamps.push_back(stamp_of(measurement));
  const auto* scan = std::get_if<std::shared_ptr<const LidarScan>>(&measurement);
  if (scan == nullptr) return;
  if (!tally.lidar) tally.lidar = std::make_unique<LidarTally>();
  const sensors::MountedSensor* mounted = rig.find(tally.sensor);
  tally.lidar->add(**scan, mounted != nullptr && mounted->lidar ? *mounted->lidar : LidarProfile());
}

const StreamTally* main_stream(const std::vector<StreamTally>& tallies) {
  const auto lidar = std::find_if(tallies.begin(), tallies.end(), [](const StreamTally& tally) {
    return tally.kind == SensorKind::kLidar;
  });
  if (lidar != tallies.end()) return &*lidar;
  return tallies.empty() ? nullptr : &tallies.front();
}

ReferenceSurvey survey_reference(const geometry::Trajectory& T_map_body,
                                 const StreamTally* stream) {
  ReferenceSurvey survey;
  survey.poses = T_map_body.size();
  survey.length_m = T_map_body.path_length();
  if (T_map_body.empty() || !T_map_body.is_stamped()) return survey;
  survey.first = T_map_body.stamps().front();
  survey.last = T_map_body.stamps().back();
  if (stream != nullptr) {
    const auto covered =
        std::count_if(stream->stamps.begin(), stream->stamps.end(),
                      [&](Stamp stamp) { return survey.first <= stamp && stamp <= survey.last; });
    survey.share_covered =
        static_cast<double>(covered) / static_cast<double>(stream->stamps.size());
  }
  return survey;
}

}  // namespace

double StreamSurvey::rate_hz() const {
  return count < 2 || duration_s() <= 0 ? 0 : static_cast<double>(count - 1) / duration_s();
}

std::size_t RecordingSurvey::measurements() const {
  std::size_t sum = 0;
  for (const StreamSurvey& stream : streams) sum += stream.count;
  return sum;
}

double RecordingSurvey::duration_s() const {
  if (streams.empty()) return 0;
  Stamp first = streams.front().first;
  Stamp last = streams.front().last;
  for (const StreamSurvey& stream : streams) {
    first = std::min(first, stream.first);
    last = std::max(last, stream.last);
  }
  return seconds_between(first, last);
}

RecordingSurvey survey(Source& source,
                       const std::function<void(const sensors::Measurement&)>& progress) {
  return survey(source, progress, [](const sensors::Measurement&) { return true; });
}

RecordingSurvey survey(Source& source,
                       const std::function<void(const sensors::Measurement&)>& progress,
                       const std::function<bool(const sensors::Measurement&)>& goes_on) {
  std::vector<StreamTally> tallies;
  std::map<std::string, std::size_t> index_of;
  while (const auto measurement = source.next()) {
    const std::string& sensor = sensor_of(*measurement);
    const auto [known, is_new] = index_of.try_emplace(sensor, tallies.size());
    if (is_new) tallies.push_back({sensor, kind_of(*measurement), {}, nullptr});
    add(tallies[known->second], *measurement, source.info().rig);
    progress(*measurement);
    if (!goes_on(*measurement)) break;
  }
  RecordingSurvey result;
  for (const StreamTally& tally : tallies) result.streams.push_back(tally.finish());
  if (source.reference()) {
    result.reference = survey_reference(source.reference()->T_map_body, main_stream(tallies));
  }
  return result;
}

}  // namespace traverse::dataset
