#include "traverse/replay/player.hpp"

#include <chrono>
#include <exception>
#include <sys/resource.h>
#include <utility>

#include <fmt/format.h>

#include "recording_index.hpp"
#include "saved_estimate.hpp"

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
  return {options.map_voxel_m > 0 ? options.map_voxel_m : usual, options.max_map_points};
}

}  // namespace

Player::Player(Recording recording, const PlayerOptions& options)
    : recording_(std::move(recording)), options_(options), map_(empty_map(recording_, options_)) {
  begin(options_.preset, recording_.first_frame());
  timeline_.limit(recording_.max_frames());
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
  const parallel::Lock lock(mutex_);
  const std::size_t wanted = controls_.wanted_in(timeline_);
  change(controls_);
  if (controls_.wanted_in(timeline_) != wanted) ahead_.reset();
  changed_.notify_all();
}

bool Player::seek(const std::string& place) {
  const parallel::Lock lock(mutex_);
  const auto frame = parse_place(place, timeline_);
  if (!frame) return false;
  controls_.seek(*frame);
  ahead_ = is_place_known(place, timeline_) ? std::nullopt : std::optional(place);
  changed_.notify_all();
  return true;
}

/// The index has grown: the place that was asked for may be another frame now.
void Player::seek_again() {
  if (!ahead_) return;
  if (const auto frame = parse_place(*ahead_, timeline_)) controls_.seek(*frame);
  if (is_place_known(*ahead_, timeline_)) ahead_.reset();
}

void Player::do_later(std::function<void()> job) {
  const parallel::Lock lock(mutex_);
  jobs_.push_back(std::move(job));
  changed_.notify_all();
}

void Player::restart(const pipeline::PresetRequest& request, std::size_t origin) {
  do_later([this, request, origin] {
    try {
      begin(request, std::max(origin, recording_.first_frame()));
    } catch (const std::exception& error) {
      const parallel::Lock lock(mutex_);  // the estimator there is goes on
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
  std::vector<std::string> columns = pipeline.estimator->columns();
  if (session_) {
    session_->restart(std::move(pipeline.estimator), origin);
  } else {
    session_ = std::make_unique<Session>(recording_.source(), std::move(pipeline.estimator),
                                         recording_.frame_sensor(), origin);
  }
  {
    const parallel::Lock lock(map_mutex_);
    map_ = empty_map(recording_, options_);
  }
  const parallel::Lock lock(mutex_);
  columns_ = std::move(columns);
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
    const parallel::Lock lock(mutex_);
    if (is_idle && !stop_) changed_.wait_for(mutex_, kTick);
  }
}

/// A job that waits, or the way to the wanted frame. \returns false if there was nothing to do
bool Player::work_once(double seconds) {
  std::function<void()> job;
  std::size_t target = 0;
  {
    const parallel::Lock lock(mutex_);
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
    const parallel::Lock lock(mutex_);
    has_job_ = false;
    return true;
  }
  const auto outcome = session_->go_to(
      target, [&](const SessionFrame& frame) { return frame_passed(frame, target); });
  if (outcome == Session::Outcome::kEnd) {
    const parallel::Lock lock(mutex_);
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
  const parallel::Lock lock(mutex_);
  status_.working_on = frame.number;
  const std::size_t wanted = controls_.advance(0, frame.number, timeline_);
  const bool still_wanted = controls_.playing() ? wanted >= target : wanted == target;
  return !stop_ && jobs_.empty() && still_wanted;
}

/// Keeps what is new of a frame: on ways back and forth the same frames come again.
void Player::remember(const SessionFrame& frame) {
  bool is_new = false;
  {
    const parallel::Lock lock(mutex_);
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
  const parallel::Lock lock(map_mutex_);
  map_.add_frame(points.points_map, points.intensity);
}

void Player::publish() {
  last_published_ = Clock::now();
  const SessionFrame& frame = *session_->frame();
  auto shown = std::make_shared<Shown>();
  shown->frame = frame.number;
  shown->pose = frame.pose;
  shown->scan = scan_to_show(frame, session_->estimator(), recording_.info().rig);
  if (session_->estimator_is_at_frame()) shown->matches = session_->estimator().matches();
  shown->local_map = session_->estimator().local_map();
  const parallel::Lock lock(mutex_);
  shown->seconds = timeline_.seconds_to(frame.number);
  status_.checkpoints = session_->checkpoints().size();
  status_.checkpoint_bytes = session_->checkpoints().bytes();
  shown_ = std::move(shown);
}

void Player::fail(const std::string& what) {
  const parallel::Lock lock(mutex_);
  controls_.pause();
  status_.error = what;
  status_.busy = false;
}

void Player::write(const std::filesystem::path& folder) {
  const auto on_show = shown();
  if (!on_show) return;
  geometry::Trajectory estimate;
  for (const PastFrame& frame : past(0)) {
    if (frame.number > on_show->frame) break;
    estimate.push_back(frame.pose.stamp, frame.pose.T_map_body);
  }
  std::string message;
  try {
    const parallel::Lock lock(map_mutex_);
    const std::size_t points = save_estimate(folder, estimate, map_, recording_.reference());
    message = fmt::format("saved {} poses and {} map points in {}", estimate.size(), points,
                          folder.string());
  } catch (const std::exception& error) {
    message = fmt::format("not saved: {}", error.what());
  }
  const parallel::Lock lock(mutex_);
  status_.message = message;
}

void Player::build_index() {
  IndexObserver observer;
  observer.stop = &stop_;
  observer.frame = [&](geometry::Stamp stamp) {
    const parallel::Lock lock(mutex_);
    timeline_.add(stamp);
    seek_again();
  };
  observer.progress = [&](double share) {
    const parallel::Lock lock(mutex_);
    status_.index_share = share;
  };
  try {
    const auto index = index_of(recording_, options_.keep_index, observer);
    if (!index) return;
    const parallel::Lock lock(mutex_);
    for (const geometry::Stamp stamp : index->frames) timeline_.add(stamp);
    timeline_.set_complete();
    status_.index_share = 1;
    skipped_ = index->skipped;
    seek_again();
  } catch (const std::exception& error) {
    const parallel::Lock lock(mutex_);
    status_.message = fmt::format("no index: {}", error.what());
  }
}

}  // namespace traverse::replay
