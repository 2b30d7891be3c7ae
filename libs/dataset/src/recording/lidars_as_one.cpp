#include "recording/lidars_as_one.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"
#include "traverse/files/numbers.hpp"
#include "traverse/geometry/angle.hpp"
#include "traverse/sensors/vertical_correction.hpp"

#include "point_clouds/scan_completion.hpp"
#include "recording/lidar_clock.hpp"
#include "recording/lidar_returns.hpp"

namespace traverse::dataset {

using geometry::Pose3;
using geometry::Stamp;
using sensors::LidarProfile;
using sensors::LidarScan;
using sensors::Measurement;
using sensors::MountedSensor;
using sensors::SensorKind;

namespace {

constexpr double kNs = 1e-9;
constexpr double kMostStatedLate_s = 10;
constexpr double kAbsent = 1.5;  ///< sweeps without the first lidar's after which it is silent

/// A lidar that is one of those used as one.
struct PartLidar {
  std::string label;
  LidarProfile profile;
  Pose3 T_first_lidar;
  std::size_t first_ring = 0;
  double to_full_scale = 1;  ///< of the first lidar's intensities
  std::int64_t late_ns = 0;  ///< its stamps, against those of the first
};

/// When a sweep of the first lidar began, and what it is stamped with.
struct Sweep {
  std::int64_t begin_ns = 0;
  Stamp stamp;
};

std::string lidars_of(const sensors::Rig& rig) {
  std::string text;
  for (const MountedSensor& sensor : rig.sensors) {
    if (sensor.kind != SensorKind::kLidar) continue;
    text += (text.empty() ? "" : ", ") + files::in_quotes(sensor.label);
  }
  return text.empty() ? "none" : text;
}

/// Shares scans and returns with the source and with its other bookmarks.
struct MergedBookmark : Bookmark {
  std::shared_ptr<const Bookmark> place;
  std::multimap<std::int64_t, Measurement> held;
  std::deque<Sweep> sweeps;
  std::deque<std::shared_ptr<const LidarReturns>> waiting;
  std::optional<std::int64_t> next_begin_ns;
  std::int64_t heard_ns = 0;
  bool at_end = false;
};

class LidarsAsOne final : public Source {
 public:
  LidarsAsOne(std::unique_ptr<Source> source, const std::vector<std::string>& labels)
      : source_(std::move(source)), info_(source_->info()) {
    for (const std::string& label : labels) add_part(label);
    describe();
    set_clocks();
  }

  const RecordingInfo& info() const override {
    // What becomes known while it is read: late sensors, and facts.
    for (const MountedSensor& sensor : source_->info().rig.sensors) {
      if (part_of(sensor.label) == nullptr && info_.rig.find(sensor.label) == nullptr) {
        info_.rig.sensors.push_back(sensor);
      }
    }
    const auto& facts = source_->info().facts;
    for (; facts_seen_ < facts.size(); ++facts_seen_) info_.facts.push_back(facts[facts_seen_]);
    return info_;
  }
  const SkippedRecords& skipped() const override { return source_->skipped(); }
  const std::optional<Reference>& reference() const override { return source_->reference(); }
  std::optional<double> share_read() const override { return source_->share_read(); }

  std::optional<Measurement> next() override {
    for (;;) {
      if (!held_.empty() && (at_end_ || held_.begin()->first < settled_ns())) {
        Measurement measurement = std::move(held_.begin()->second);
        held_.erase(held_.begin());
        return measurement;
      }
      if (at_end_) return std::nullopt;
      read_one();
    }
  }

  void rewind() override {
    source_->rewind();
    held_.clear();
    sweeps_.clear();
    waiting_.clear();
    next_begin_ns_.reset();
    heard_ns_ = std::numeric_limits<std::int64_t>::min();
    at_end_ = false;
  }

  std::shared_ptr<const Bookmark> bookmark() const override {
    auto place = source_->bookmark();
    if (place == nullptr) return nullptr;
    auto here = std::make_shared<MergedBookmark>();
    here->place = std::move(place);
    here->held = held_;
    here->sweeps = sweeps_;
    here->waiting = waiting_;
    here->next_begin_ns = next_begin_ns_;
    here->heard_ns = heard_ns_;
    here->at_end = at_end_;
    return here;
  }

  void return_to(const Bookmark& bookmark) override {
    const auto& there = dynamic_cast<const MergedBookmark&>(bookmark);
    source_->return_to(*there.place);
    held_ = there.held;
    sweeps_ = there.sweeps;
    waiting_ = there.waiting;
    next_begin_ns_ = there.next_begin_ns;
    heard_ns_ = there.heard_ns;
    at_end_ = there.at_end;
  }

 private:
  void add_part(const std::string& label) {
    const MountedSensor* sensor = info_.rig.find(label);
    if (sensor == nullptr || sensor->kind != SensorKind::kLidar || part_of(label) != nullptr) {
      throw files::InputError(info_.path, files::Place::key(kLidarsAsOne),
                              "labels of different lidars, which are " + lidars_of(info_.rig),
                              files::in_quotes(label));
    }
    PartLidar part{label, sensor->lidar.value_or(LidarProfile()), Pose3::identity(), 0, 1, 0};
    if (!parts_.empty()) {
      part.T_first_lidar =
          info_.rig.find(parts_.front().label)->T_body_sensor.inverse() * sensor->T_body_sensor;
      part.first_ring = parts_.back().first_ring + rings_of(parts_.back().profile);
      part.to_full_scale =
          parts_.front().profile.intensity_full_scale / part.profile.intensity_full_scale;
    }
    parts_.push_back(std::move(part));
  }

  static std::size_t rings_of(const LidarProfile& profile) {
    constexpr std::size_t kIfUnknown = 256;
    return profile.rings > 0 ? static_cast<std::size_t>(profile.rings) : kIfUnknown;
  }

  void describe() {
    const PartLidar& first = parts_.front();
    LidarProfile profile = first.profile;
    std::string names;
    double largest_m = 0;
    double lever_m = 0;
    for (const PartLidar& part : parts_) {
      names += (names.empty() ? "" : " + ") + part.label;
      largest_m = std::max(largest_m, part.profile.max_range_m);
      lever_m = std::max(lever_m, part.T_first_lidar.translation.norm());
      sweep_s_ = std::max(sweep_s_, part.profile.sweep_s);
      const Eigen::Vector3d& origin = part.T_first_lidar.translation;
      profile.lidars_in_scan.push_back({part.first_ring, {origin.x(), origin.y(), origin.z()}});
    }
    profile.name = names;
    profile.rings = static_cast<int>(parts_.back().first_ring + rings_of(parts_.back().profile));
    // Each return was held against the limits of its own lidar.
    profile.min_range_m = 0;
    profile.max_range_m = largest_m + lever_m;
    profile.ring_source = sensors::RingSource::kData;
    profile.time_source = sensors::TimeSource::kData;
    profile.elevations_deg.clear();  // seen from the first, the others' beams are no cones
    profile.firing = {};
    profile.vertical_correction_deg = 0;
    info_.motion_compensated = false;
    facts_seen_ = source_->info().facts.size();
    info_.is_listed = false;
    info_.expected_scans = 0;
    std::vector<MountedSensor> sensors;
    for (const MountedSensor& sensor : info_.rig.sensors) {
      if (sensor.label == first.label) {  // before other lidars, which nobody asked for
        sensors.insert(sensors.begin(), sensor);
        sensors.front().label = names;
        sensors.front().lidar = profile;
      } else if (part_of(sensor.label) == nullptr) {
        sensors.push_back(sensor);
      }
    }
    info_.rig.sensors = std::move(sensors);
    label_ = names;
    for (const MountedSensor& sensor : info_.rig.sensors) {
      if (sensor.kind != SensorKind::kLidar || sensor.label == label_) continue;
      info_.facts.push_back({"lidar not used", sensor.label, "it is not among those stated"});
    }
    for (Fact& fact : info_.facts) {
      if (fact.name == kLidarsAsOne) fact.value = names + ", in the frame of the first";
      if (fact.name == "motion compensated" && source_->info().motion_compensated) {
        fact = {"motion compensated", "no", "each lidar's scans to its own stamps, which differ"};
      }
    }
  }

  /// What is stated of the clocks, or else what the scans tell.
  void set_clocks() {
    if (parts_.size() < 2) return;
    for (const Fact& fact : source_->info().facts) {
      if (fact.name != kLidarsLate) continue;
      take_stated_clocks(fact);
      return;
    }
    measure_clocks();
  }

  void take_stated_clocks(const Fact& stated) {
    const auto cells = files::split_cells(stated.value, ',');
    std::vector<double> seconds;
    for (const auto cell : cells) {
      const auto value = files::parse_double(cell);
      if (value && std::abs(*value) <= kMostStatedLate_s) seconds.push_back(*value);
    }
    if (seconds.size() != cells.size() || seconds.size() + 1 != parts_.size()) {
      throw files::InputError(
          info_.path, files::Place::key(kLidarsLate),
          fmt::format("{} of seconds up to {}, one for each of `{}` but the first",
                      parts_.size() == 2 ? "a number" : "numbers", kMostStatedLate_s, kLidarsAsOne),
          files::in_quotes(stated.value));
    }
    for (std::size_t i = 0; i < seconds.size(); ++i) {
      parts_[i + 1].late_ns = std::llround(seconds[i] / kNs);
    }
  }

  /// Sweeps of the first lidar and what the others measured, as far as they are needed together.
  struct ReadAhead {
    std::deque<LidarReturns> sweeps;
    std::vector<LidarReturns> others;  ///< by part
    std::size_t seen = 0;              ///< sweeps
  };

  /// From the beginning, as far as it takes; ends at the beginning.
  void measure_clocks() {
    constexpr std::size_t kMostSweeps = 300;
    const Eigen::Vector3d ahead_first =
        info_.rig.find(label_)->T_body_sensor.rotation.transpose() * Eigen::Vector3d::UnitX();
    std::vector<LidarClock> clocks(parts_.size(), LidarClock(ahead_first));
    ReadAhead ahead;
    ahead.others.resize(parts_.size());
    const bool has_times = !source_->info().motion_compensated;
    while (has_times && ahead.seen < kMostSweeps) {
      const auto measurement = source_->next();
      if (!measurement) break;
      const auto* scan = std::get_if<std::shared_ptr<const LidarScan>>(&*measurement);
      const PartLidar* part = scan == nullptr ? nullptr : part_of((*scan)->sensor);
      if (part == nullptr) continue;
      if (!has_own_times(**scan, *part)) break;
      read_ahead(**scan, *part, ahead, clocks);
      const bool are_known = std::all_of(clocks.begin() + 1, clocks.end(),
                                         [](const LidarClock& clock) { return clock.is_known(); });
      if (are_known) break;
    }
    source_->rewind();
    for (std::size_t i = 1; i < parts_.size(); ++i) tell_clock(parts_[i], clocks[i]);
  }

  static bool has_own_times(const LidarScan& scan, const PartLidar& part) {
    return !derive_point_data(scan, part.profile).time.empty();
  }

  void read_ahead(const LidarScan& scan, const PartLidar& part, ReadAhead& ahead,
                  std::vector<LidarClock>& clocks) {
    constexpr std::size_t kHeld = 4;  // then the others were heard behind the second
    constexpr std::size_t kApart = 3;
    const auto index = static_cast<std::size_t>(&part - parts_.data());
    LidarReturns returns = returns_of(scan, part);
    if (index > 0) {
      for (std::size_t i = 0; i < returns.size(); ++i) returns.move_to(ahead.others[index], i);
      return;
    }
    if (returns.size() == 0) return;
    ++ahead.seen;
    ahead.sweeps.push_back(std::move(returns));
    if (ahead.sweeps.size() < kHeld) return;
    const auto begin_of = [](const LidarReturns& sweep) {
      return *std::min_element(sweep.ns.begin(), sweep.ns.end());
    };
    const std::int64_t begin_ns = begin_of(ahead.sweeps[0]);
    const std::int64_t end_ns = begin_of(ahead.sweeps[2]);
    const std::int64_t kept_ns = begin_of(ahead.sweeps[kApart]);
    const bool is_whole = end_ns - begin_ns < 3 * sweep_ns();
    for (std::size_t other = 1; other < parts_.size(); ++other) {
      LidarReturns during;
      LidarReturns behind;
      const LidarReturns& heard = ahead.others[other];
      for (std::size_t i = 0; i < heard.size(); ++i) {
        if (heard.ns[i] >= begin_ns && heard.ns[i] < end_ns) heard.move_to(during, i);
        if (heard.ns[i] >= kept_ns) heard.move_to(behind, i);
      }
      if (is_whole) clocks[other].add(ahead.sweeps[0], ahead.sweeps[1], during);
      ahead.others[other] = std::move(behind);
    }
    ahead.sweeps.erase(ahead.sweeps.begin(), ahead.sweeps.begin() + kApart);
  }

  void tell_clock(PartLidar& part, const LidarClock& clock) {
    const std::string name = "clock of " + part.label;
    const auto found = clock.lateness();
    constexpr double kTold_s = 1e-3;  // a worse one would move more than it mends
    if (!found || found->sigma_s > kTold_s) {
      info_.facts.push_back({name, "taken to be that of " + parts_.front().label,
                             fmt::format("too few sweeps in motion see the same; {} states how "
                                         "late it is",
                                         kLidarsLate)});
      return;
    }
    part.late_ns = std::llround(found->late_s / kNs);
    info_.facts.push_back(
        {name,
         fmt::format("{:.2f} ms late against {} (± {:.2f} ms)", found->late_s * 1e3,
                     parts_.front().label, found->sigma_s * 1e3),
         fmt::format("surfaces that both saw in {} pairs of sweeps in motion; {} states another",
                     found->sweeps, kLidarsLate)});
  }

  const PartLidar* part_of(const std::string& label) const {
    const auto found = std::find_if(parts_.begin(), parts_.end(),
                                    [&](const PartLidar& part) { return part.label == label; });
    return found == parts_.end() ? nullptr : &*found;
  }

  std::int64_t sweep_ns() const { return std::llround(sweep_s_ / kNs); }

  /// How long a return may come after others that were measured when it was.
  std::int64_t slack_ns() const {
    std::int64_t latest_ns = 0;
    for (const PartLidar& part : parts_) latest_ns = std::max(latest_ns, std::abs(part.late_ns));
    return 3 * sweep_ns() + latest_ns;
  }

  /// Nothing that is not held yet has an earlier stamp.
  std::int64_t settled_ns() const {
    std::int64_t settled = heard_ns_ - slack_ns();
    if (!sweeps_.empty()) settled = std::min(settled, sweeps_.front().begin_ns);
    if (next_begin_ns_ && !waiting_.empty()) settled = std::min(settled, *next_begin_ns_);
    return settled;
  }

  void read_one() {
    auto measurement = source_->next();
    if (!measurement) {
      at_end_ = true;
      make_scans(std::numeric_limits<std::int64_t>::max());
      return;
    }
    const Stamp stamp = stamp_of(*measurement);
    if (heard_ns_ == std::numeric_limits<std::int64_t>::min()) heard_ns_ = stamp.nanoseconds;
    heard_ns_ = std::max(heard_ns_, stamp.nanoseconds);
    const auto* scan = std::get_if<std::shared_ptr<const LidarScan>>(&*measurement);
    const PartLidar* part = scan == nullptr ? nullptr : part_of((*scan)->sensor);
    if (part != nullptr) {
      take(**scan, *part);
    } else {
      held_.emplace(stamp.nanoseconds, std::move(*measurement));
    }
    make_scans(heard_ns_);
  }

  /// What a scan holds in the frame of the first lidar, by the first one's clock.
  LidarReturns returns_of(const LidarScan& scan, const PartLidar& part) const {
    const DerivedPointData derived = derive_point_data(scan, part.profile);
    std::vector<float> x = scan.x;
    std::vector<float> y = scan.y;
    std::vector<float> z = scan.z;
    if (part.profile.vertical_correction_deg != 0) {
      sensors::correct_elevation(x.data(), y.data(), z.data(), x.size(),
                                 part.profile.vertical_correction_deg * geometry::kDegree);
    }
    const bool is_moved = source_->info().motion_compensated;
    LidarReturns returns;
    const std::int64_t stamp_ns = scan.stamp.nanoseconds - part.late_ns;
    for (std::size_t i = 0; i < scan.size(); ++i) {
      // Scans that were moved to their stamp, or whose times nobody knows, are of that moment.
      const double after_s =
          is_moved || derived.time.empty() ? 0 : static_cast<double>(derived.time[i]);
      if (std::isnan(after_s)) continue;
      const Eigen::Vector3d p_lidar(x[i], y[i], z[i]);
      const double range = p_lidar.norm();
      if (!(range >= part.profile.min_range_m && range <= part.profile.max_range_m) || range == 0) {
        continue;
      }
      const Eigen::Vector3f p = (part.T_first_lidar * p_lidar).cast<float>();
      returns.x.push_back(p.x());
      returns.y.push_back(p.y());
      returns.z.push_back(p.z());
      const float intensity = scan.intensity.empty() ? 0 : scan.intensity[i];
      returns.intensity.push_back(
          static_cast<float>(part.to_full_scale * static_cast<double>(intensity)));
      const std::size_t ring = derived.ring.empty() ? 0 : derived.ring[i];
      returns.ring.push_back(static_cast<std::uint16_t>(part.first_ring + ring));
      returns.ns.push_back(stamp_ns + std::llround(after_s / kNs));
    }
    return returns;
  }

  void take(const LidarScan& scan, const PartLidar& part) {
    LidarReturns returns = returns_of(scan, part);
    if (returns.size() == 0) return;
    const std::int64_t begin_ns = *std::min_element(returns.ns.begin(), returns.ns.end());
    if (&part == &parts_.front()) sweeps_.push_back({begin_ns, scan.stamp});
    if (!next_begin_ns_) next_begin_ns_ = begin_ns;
    waiting_.push_back(std::make_shared<const LidarReturns>(std::move(returns)));
  }

  /// Makes the sweeps whose returns are all there when everything until `heard_ns` was heard.
  void make_scans(std::int64_t heard_ns) {
    const std::int64_t sweep = sweep_ns();
    const auto absent = static_cast<std::int64_t>(kAbsent * static_cast<double>(sweep));
    while (!waiting_.empty() && next_begin_ns_) {
      const std::int64_t from_ns = *next_begin_ns_;
      if (heard_ns - slack_ns() < from_ns && !at_end_) return;
      std::int64_t end_ns = from_ns + sweep;
      std::optional<Stamp> stamp;
      if (!sweeps_.empty() && sweeps_.front().begin_ns < from_ns + sweep / 2) {
        stamp = sweeps_.front().stamp;
        sweeps_.pop_front();
        if (!sweeps_.empty() && sweeps_.front().begin_ns < from_ns + absent) {
          end_ns = sweeps_.front().begin_ns;
        }
      } else {
        if (!sweeps_.empty()) end_ns = std::min(end_ns, sweeps_.front().begin_ns);
        const double over = parts_.front().profile.stamp_fraction;
        stamp = Stamp{from_ns + std::llround(over * static_cast<double>(sweep))};
      }
      make_scan(end_ns, *stamp);
      next_begin_ns_ = end_ns;
      skip_silence();
    }
  }

  /// Where nobody measured anything for long, there is no sweep.
  void skip_silence() {
    std::int64_t earliest = std::numeric_limits<std::int64_t>::max();
    for (const auto& returns : waiting_) {
      earliest = std::min(earliest, *std::min_element(returns->ns.begin(), returns->ns.end()));
    }
    if (waiting_.empty()) {
      if (sweeps_.empty()) next_begin_ns_.reset();
      return;
    }
    if (earliest > *next_begin_ns_ + sweep_ns() || earliest < *next_begin_ns_) {
      next_begin_ns_ = earliest;
    }
  }

  /// Of all returns before `end_ns` that wait.
  void make_scan(std::int64_t end_ns, Stamp stamp) {
    LidarReturns taken;
    std::deque<std::shared_ptr<const LidarReturns>> left;
    for (const auto& returns : waiting_) {
      LidarReturns rest;
      for (std::size_t i = 0; i < returns->size(); ++i) {
        returns->move_to(returns->ns[i] < end_ns ? taken : rest, i);
      }
      if (rest.size() > 0) left.push_back(std::make_shared<const LidarReturns>(std::move(rest)));
    }
    waiting_ = std::move(left);
    if (taken.size() == 0) return;
    auto scan = std::make_shared<LidarScan>();
    scan->stamp = stamp;
    scan->sensor = label_;
    scan->x = std::move(taken.x);
    scan->y = std::move(taken.y);
    scan->z = std::move(taken.z);
    scan->intensity = std::move(taken.intensity);
    scan->ring = std::move(taken.ring);
    scan->time.reserve(taken.ns.size());
    for (const std::int64_t ns : taken.ns) {
      scan->time.push_back(static_cast<float>(static_cast<double>(ns - stamp.nanoseconds) * kNs));
    }
    held_.emplace(stamp.nanoseconds, std::shared_ptr<const LidarScan>(std::move(scan)));
  }

  std::unique_ptr<Source> source_;
  mutable RecordingInfo info_;
  mutable std::size_t facts_seen_ = 0;
  std::vector<PartLidar> parts_;
  std::string label_;
  double sweep_s_ = 0;

  std::multimap<std::int64_t, Measurement> held_;  ///< by stamp
  std::deque<Sweep> sweeps_;                       ///< of the first lidar, not made into scans yet
  std::deque<std::shared_ptr<const LidarReturns>> waiting_;
  std::optional<std::int64_t> next_begin_ns_;  ///< of the sweep that is made next
  std::int64_t heard_ns_ = std::numeric_limits<std::int64_t>::min();
  bool at_end_ = false;
};

}  // namespace

std::vector<std::string> labels_of_lidars(const std::string& list) {
  std::vector<std::string> labels;
  for (const auto label : files::split_cells(list, ',')) {
    const auto first = label.find_first_not_of(' ');
    if (first == std::string_view::npos) continue;
    labels.emplace_back(label.substr(first, label.find_last_not_of(' ') - first + 1));
  }
  return labels;
}

std::string with_list_as_text(const std::string& statement) {
  const std::size_t equals = statement.find('=');
  const std::string name = statement.substr(0, equals);
  if (equals == std::string::npos || (name != kLidarsAsOne && name != kLidarsLate))
    return statement;
  const std::string key = name + "=";
  const std::string list = statement.substr(key.size());
  if (list.empty() || list.front() == '"' || list.front() == '\'') return statement;
  std::string text = key + "'";
  for (const char c : list) text += c == '\'' ? std::string("''") : std::string(1, c);
  return text + "'";
}

std::unique_ptr<Source> with_lidars_as_one(std::unique_ptr<Source> source) {
  for (const Fact& fact : source->info().facts) {
    if (fact.name != kLidarsAsOne) continue;
    const std::vector<std::string> labels = labels_of_lidars(fact.value);
    if (labels.empty()) continue;
    return std::make_unique<LidarsAsOne>(std::move(source), labels);
  }
  return source;
}

}  // namespace traverse::dataset
