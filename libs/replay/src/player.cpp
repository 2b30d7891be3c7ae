#include "traverse/replay/player.hpp"

#include <chrono>
#include <exception>
#include <sys/resource.h>
#include <utility>

#include <fmt/format.h>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/files/atomic_file.hpp"

namespace traverse::replay {

namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kTick = std::chrono::milliseconds(4);  // of the playing clock
/// On a long way to a frame, one on the way is shown this often.
constexpr auto kShowEvery = std::chrono::milliseconds(50);
constexpr double kLongestReferenceGap = 1;  // seconds
constexpr int kNiceness = 5;
constexpr double kVoxel = 0.25;  // of the drawn map, metres
constexpr double kPlanarVoxel = 0.05;

/// The window goes before the estimator where both want the same core. (On Linux this is of the
/// calling thread alone; that it may fail does not matter.)
void give_way() { ::setpriority(PRIO_PROCESS, 0, kNiceness); }

MapHistory empty_map(const Recording& recording, const PlayerOptions& options) {
  const double usual = recording.has_lidar() ? kVoxel : kPlanarVoxel;
  return {options.map_voxel_m > 0 ? options.map_voxel_m : usual, options.most_map_points};
}

}  // namespace

Player::Player(Recording recording, const PlayerOptions& options)
    : recording_(std::move(recording)), options_(options), map_(empty_map(recording_, options_)) {
  begin(options_.preset, recording_.first_frame());
  timeline_.limit(recording_.most_frames());
  estimating_ = std::thread([this] { estimate(); });
  indexing_ = std::thread([this] { build_index(); });
}

Player::~Player() {
  stop_ = true;
  changed_.notify_all();
  estimating_.join();
  indexing_.join();
}

void Player::control(const std::function<void(Controls&)>& change) {
  const std::lock_guard lock(mutex_);
  change(controls_);
  changed_.notify_all();
}

bool Player::seek(const std::string& place) {
  const std::lock_guard lock(mutex_);
  const auto frame = parse_place(place, timeline_);
  if (frame) controls_.seek(*frame);
  changed_.notify_all();
  return frame.has_value();
}

PlayerStatus Player::status() const {
  const std::lock_guard lock(mutex_);
  PlayerStatus status = status_;
  status.playing = controls_.playing();
  status.unlimited = controls_.unlimited();
  status.loop = controls_.loop();
  status.speed = controls_.speed();
  status.origin = controls_.origin();
  status.range_first = controls_.range_first();
  status.range_last = controls_.range_last();
  status.frames = timeline_.size();
  status.frames_complete = timeline_.complete();
  if (shown_) status.shown = shown_->frame;
  status.settled =
      jobs_.empty() && !has_job_ && shown_ && controls_.is_settled(shown_->frame, timeline_);
  return status;
}

Timeline Player::timeline() const {
  const std::lock_guard lock(mutex_);
  return timeline_;
}

std::vector<FrameIndex::Skipped> Player::skipped() const {
  const std::lock_guard lock(mutex_);
  return skipped_;
}

std::shared_ptr<const Shown> Player::shown() const {
  const std::lock_guard lock(mutex_);
  return shown_;
}

std::vector<PastFrame> Player::past(std::size_t from) const {
  const std::lock_guard lock(mutex_);
  if (from >= past_.size()) return {};
  return {past_.begin() + static_cast<std::ptrdiff_t>(from), past_.end()};
}

std::vector<Eigen::Vector3d> Player::reference_in_map() const {
  std::optional<geometry::Pose3> T_map_reference;
  {
    const std::lock_guard lock(mutex_);
    T_map_reference = T_map_reference_;
  }
  std::vector<Eigen::Vector3d> points;
  if (!T_map_reference) return points;
  for (const geometry::Pose3& pose : recording_.reference()->T_map_body.poses()) {
    points.push_back(*T_map_reference * pose.translation);
  }
  return points;
}

std::optional<ChosenPoints> Player::choose_map(const Eigen::Vector3f& focus,
                                               std::size_t budget) const {
  const auto on_show = shown();
  std::size_t origin = 0;
  {
    const std::lock_guard lock(mutex_);
    origin = controls_.origin();
  }
  const std::unique_lock lock(map_mutex_, std::try_to_lock);
  if (!lock) return std::nullopt;
  const std::size_t frames = on_show && on_show->frame >= origin ? on_show->frame - origin + 1 : 0;
  return map_.choose(frames, focus, budget);
}

std::vector<pipeline::ResolvedSetting> Player::settings() const {
  const std::lock_guard lock(mutex_);
  return settings_;
}

void Player::do_later(std::function<void()> job) {
  const std::lock_guard lock(mutex_);
  jobs_.push_back(std::move(job));
  changed_.notify_all();
}

void Player::restart(const pipeline::PresetRequest& request, std::size_t origin) {
  do_later([this, request, origin] {
    try {
      begin(request, std::max(origin, recording_.first_frame()));
    } catch (const std::exception& error) {
      const std::lock_guard lock(mutex_);  // the estimator there is goes on
      status_.message = fmt::format("not restarted: {}", error.what());
    }
  });
}

void Player::save(const std::filesystem::path& folder) {
  do_later([this, folder] { write(folder); });
}

/// Makes the pipeline and forgets what the one before knew.
void Player::begin(const pipeline::PresetRequest& request, std::size_t origin) {
  pipeline::Pipeline pipeline = recording_.make_pipeline(request, options_.threads);
  const std::vector<std::string> columns = pipeline.estimator->columns();
  if (session_) {
    session_->restart(std::move(pipeline.estimator), origin);
  } else {
    session_ = std::make_unique<Session>(recording_.source(), std::move(pipeline.estimator),
                                         recording_.frame_sensor(), origin);
  }
  {
    const std::lock_guard lock(map_mutex_);
    map_ = empty_map(recording_, options_);
  }
  const std::lock_guard lock(mutex_);
  columns_ = columns;
  controls_.set_origin(origin);
  settings_ = std::move(pipeline.settings);
  past_.clear();
  T_map_reference_.reset();
  shown_.reset();
  ++status_.generation;
  status_.pipeline = pipeline.name;
  status_.error.clear();
  status_.message = fmt::format("{} begins at frame {}", pipeline.name, origin);
}

void Player::estimate() {
  give_way();
  auto last = Clock::now();
  while (!stop_) {
    const auto now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - last).count();
    last = now;
    bool is_idle = true;
    try {
      is_idle = !work_once(seconds);
    } catch (const std::exception& error) {
      fail(error.what());
    }
    std::unique_lock lock(mutex_);
    if (is_idle && !stop_) changed_.wait_for(lock, kTick);
  }
}

/// A job that waits, or the way to the wanted frame. \returns false if there was nothing to do
bool Player::work_once(double seconds) {
  std::function<void()> job;
  std::size_t target = 0;
  {
    const std::lock_guard lock(mutex_);
    if (!jobs_.empty()) {
      job = std::move(jobs_.front());
      jobs_.pop_front();
      has_job_ = true;
    } else if (!status_.error.empty()) {
      return false;
    } else {
      const std::size_t shown = session_->frame() ? session_->frame()->number : controls_.origin();
      target = controls_.advance(seconds, shown, timeline_);
      status_.wanted = target;
      const bool there = shown_ && shown_->frame == std::max(target, controls_.origin());
      status_.busy = !there;
      if (there) return false;
    }
  }
  if (job) {
    job();
    const std::lock_guard lock(mutex_);
    has_job_ = false;
    return true;
  }
  const auto outcome = session_->go_to(
      target, [&](const SessionFrame& frame) { return frame_passed(frame, target); });
  if (outcome == Session::Outcome::kEnd) {
    const std::lock_guard lock(mutex_);
    timeline_.confirm_end(session_->frame() ? session_->frame()->number + 1 : 0);
    if (!session_->frame()) {
      status_.error = "the recording has no frame that the estimator can use";
      return true;
    }
    controls_.seek(session_->frame()->number);
  }
  if (outcome != Session::Outcome::kStopped) publish();
  return true;
}

/// \returns whether to go on to `target`
bool Player::frame_passed(const SessionFrame& frame, std::size_t target) {
  remember(frame);
  if (frame.number != target && Clock::now() - last_published_ >= kShowEvery) publish();
  const std::lock_guard lock(mutex_);
  status_.working_on = frame.number;
  const std::size_t wanted = controls_.advance(0, frame.number, timeline_);
  const bool still_wanted = controls_.playing() ? wanted >= target : wanted == target;
  return !stop_ && jobs_.empty() && still_wanted;
}

/// Keeps what is new of a frame: on ways back and forth the same frames come again.
void Player::remember(const SessionFrame& frame) {
  bool is_new = false;
  {
    const std::lock_guard lock(mutex_);
    timeline_.confirm(frame.number, frame.pose.stamp);
    is_new = frame.number == controls_.origin() + past_.size();
    if (is_new) {
      PastFrame past{frame.number, frame.pose, std::nullopt};
      const auto& reference = recording_.reference();
      const auto truth = reference
                             ? reference->T_map_body.at(frame.pose.stamp, kLongestReferenceGap)
                             : std::nullopt;
      if (truth && !T_map_reference_) {
        T_map_reference_ = frame.pose.T_map_body * truth->inverse();
      }
      if (truth) {
        past.error_m =
            (*T_map_reference_ * truth->translation - frame.pose.T_map_body.translation).norm();
      }
      past_.push_back(std::move(past));
    }
  }
  if (!is_new) return;
  const MapPoints points = points_in_map(frame, session_->estimator(), recording_.info().rig);
  const std::lock_guard lock(map_mutex_);
  map_.add_frame(points.points_map, points.intensity);
}

void Player::publish() {
  last_published_ = Clock::now();
  const SessionFrame& frame = *session_->frame();
  auto shown = std::make_shared<Shown>();
  shown->frame = frame.number;
  shown->pose = frame.pose;
  shown->scan = scan_to_show(frame, session_->estimator(), recording_.info().rig);
  shown->matches = session_->estimator().matches();
  shown->local_map = session_->estimator().local_map();
  const std::lock_guard lock(mutex_);
  shown->seconds = timeline_.seconds_to(frame.number);
  status_.checkpoints = session_->checkpoints().size();
  shown_ = std::move(shown);
}

void Player::fail(const std::string& what) {
  const std::lock_guard lock(mutex_);
  controls_.pause();
  status_.error = what;
  status_.busy = false;
}

void Player::write(const std::filesystem::path& folder) {
  const auto on_show = shown();
  if (!on_show) return;
  try {
    files::make_writable_folder(folder);
    geometry::Trajectory trajectory;
    for (const PastFrame& frame : past(0)) {
      if (frame.number > on_show->frame) break;
      trajectory.push_back(frame.pose.stamp, frame.pose.T_map_body);
    }
    dataset::write_tum(folder / "trajectory.tum", trajectory);
    if (recording_.reference()) {
      dataset::write_tum(folder / "reference.tum", recording_.reference()->T_map_body);
    }
    dataset::PointCloud cloud;
    {
      const std::lock_guard lock(map_mutex_);
      const std::size_t size = map_.size_at(trajectory.size());
      std::vector<float> x, y, z;
      for (std::size_t i = 0; i < size; ++i) {
        x.push_back(map_.points()[i].x());
        y.push_back(map_.points()[i].y());
        z.push_back(map_.points()[i].z());
      }
      cloud.add("x", std::move(x));
      cloud.add("y", std::move(y));
      cloud.add("z", std::move(z));
      cloud.add("intensity",
                std::vector<float>(map_.intensities().begin(),
                                   map_.intensities().begin() + static_cast<std::ptrdiff_t>(size)));
    }
    dataset::write_ply(folder / "map.ply", cloud);
    const std::lock_guard lock(mutex_);
    status_.message = fmt::format("saved {} poses and {} map points in {}", trajectory.size(),
                                  cloud.size(), folder.string());
  } catch (const std::exception& error) {
    const std::lock_guard lock(mutex_);
    status_.message = fmt::format("not saved: {}", error.what());
  }
}

void Player::build_index() {
  try {
    const auto source = recording_.source();
    const auto add = [&](const std::vector<geometry::Stamp>& stamps) {
      const std::lock_guard lock(mutex_);
      for (const geometry::Stamp stamp : stamps) timeline_.add(stamp);
      timeline_.set_complete();
      status_.index_share = 1;
    };
    if (const auto listed = source->listed_scan_stamps()) return add(*listed);

    const auto file = options_.keep_index ? index_file(recording_.info().path) : std::nullopt;
    const std::string digest = file ? quick_digest(recording_.info().path) : "";
    std::optional<FrameIndex> index;
    if (file) index = load_index(*file, digest, recording_.frame_sensor());
    if (!index) {
      IndexObserver observer;
      observer.stop = &stop_;
      observer.frame = [&](geometry::Stamp stamp) {
        const std::lock_guard lock(mutex_);
        timeline_.add(stamp);
      };
      observer.progress = [&](double share) {
        const std::lock_guard lock(mutex_);
        status_.index_share = share;
      };
      index = replay::build_index(*source, recording_.frame_sensor(), observer);
      if (!index) return;
      if (file) save_index(*file, digest, recording_.frame_sensor(), *index);
    }
    add(index->frames);
    const std::lock_guard lock(mutex_);
    skipped_ = index->skipped;
  } catch (const std::exception& error) {
    const std::lock_guard lock(mutex_);
    status_.message = fmt::format("no index: {}", error.what());
  }
}

}  // namespace traverse::replay
