// What others read of a player. Everything is handed out as a copy or as something that does not
// change, so that locks are held for moments only.

#include "traverse/replay/player.hpp"

namespace traverse::replay {

PlayerStatus Player::status() const {
  const parallel::Lock lock(mutex_);
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
  status.settled = jobs_.empty() && !has_job_ && !ahead_ && shown_ &&
                   controls_.is_settled(shown_->frame, timeline_);
  return status;
}

Timeline Player::timeline() const {
  const parallel::Lock lock(mutex_);
  return timeline_;
}

std::vector<FrameIndex::Skipped> Player::skipped() const {
  const parallel::Lock lock(mutex_);
  return skipped_;
}

std::shared_ptr<const Shown> Player::shown() const {
  const parallel::Lock lock(mutex_);
  return shown_;
}

std::vector<PastFrame> Player::past(std::size_t from) const {
  const parallel::Lock lock(mutex_);
  if (from >= past_.size()) return {};
  return {past_.begin() + static_cast<std::ptrdiff_t>(from), past_.end()};
}

std::vector<std::string> Player::columns() const {
  const parallel::Lock lock(mutex_);
  return columns_;
}

std::vector<Eigen::Vector3d> Player::reference_in_map() const {
  std::optional<geometry::Pose3> T_map_reference;
  {
    const parallel::Lock lock(mutex_);
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
    const parallel::Lock lock(mutex_);
    origin = controls_.origin();
  }
  if (!map_mutex_.try_lock()) return std::nullopt;
  const parallel::Lock lock(map_mutex_, parallel::Adopt{});
  const std::size_t frames = on_show && on_show->frame >= origin ? on_show->frame - origin + 1 : 0;
  return map_.choose(frames, focus, budget);
}

std::vector<pipeline::ResolvedSetting> Player::settings() const {
  const parallel::Lock lock(mutex_);
  return settings_;
}

}  // namespace traverse::replay
