#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "traverse/parallel/mutex.hpp"
#include "traverse/pipeline/preset.hpp"
#include "traverse/pipeline/registry.hpp"
#include "traverse/replay/controls.hpp"
#include "traverse/replay/frame_index.hpp"
#include "traverse/replay/map_history.hpp"
#include "traverse/replay/recording.hpp"
#include "traverse/replay/session.hpp"
#include "traverse/replay/shown.hpp"
#include "traverse/replay/timeline.hpp"

namespace traverse::replay {

struct PlayerOptions {
  pipeline::PresetRequest preset;
  int threads = 1;
  double map_voxel_m = 0;  ///< 0: 0.25 with a 3-D lidar, else 0.05
  std::size_t max_map_points = 4'000'000;
  bool keep_index = true;  ///< in the user's cache folder
};

/// What is kept of every frame that was estimated.
struct PastFrame {
  std::size_t number = 0;
  pipeline::PoseFrame pose;
  std::optional<double> error_m;  ///< distance to the reference, aligned at the first frame
};

/// How things stand, for panels.
struct PlayerStatus {
  bool playing = false;
  bool unlimited = false;
  bool loop = false;
  double speed = 1;
  std::size_t origin = 0;
  std::size_t wanted = 0;
  std::optional<std::size_t> range_first, range_last;
  std::optional<std::size_t> shown;  ///< number of the frame on show
  std::size_t working_on = 0;        ///< the frame that the estimator has come to
  bool busy = false;                 ///< the estimator is on its way to the wanted frame
  bool settled = false;              ///< paused, the wanted frame is on show and no job waits
  std::size_t frames = 0;            ///< known so far
  bool frames_complete = false;
  double index_share = 0;  ///< of the recording that the index has been through
  std::size_t checkpoints = 0;
  std::size_t checkpoint_bytes = 0;
  std::string pipeline;
  std::string error;        ///< why the estimator cannot go on; empty if all is well
  std::string message;      ///< of the last thing that was done: "saved ..."
  unsigned generation = 0;  ///< grows when the estimator begins again: what was known is gone
};

/// Plays a recording: an estimator on a thread of its own, an index built on another. Every member
/// may be called from any thread and returns at once.
class Player {
 public:
  /// \throws what making the pipeline throws
  Player(Recording recording, const PlayerOptions& options);
  ~Player();
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;

  const Recording& recording() const { return recording_; }

  /// Does something to the controls.
  void control(const std::function<void(Controls&)>& change);
  /// Seeks to what a person typed (parse_place()); again and again while the index has not come to
  /// it, until another seek or step. \returns false if it names no frame
  bool seek(const std::string& place);

  PlayerStatus status() const;
  Timeline timeline() const;
  std::vector<FrameIndex::Skipped> skipped() const;

  /// The frame on show; null before the first.
  std::shared_ptr<const Shown> shown() const;

  /// The frames from the `from`th known one on; empty when that is the newest.
  std::vector<PastFrame> past(std::size_t from) const;
  /// Names of the values of PoseFrame::record, by the present configuration.
  std::vector<std::string> columns() const;

  /// The reference in the map frame of the present estimate; empty without one.
  std::vector<Eigen::Vector3d> reference_in_map() const;

  /// Points of the map up to the frame on show (MapHistory::choose()); nothing if the map is being
  /// changed just now: ask again with the next picture.
  std::optional<ChosenPoints> choose_map(const Eigen::Vector3f& focus, std::size_t budget) const;

  /// The resolved settings of the present pipeline.
  std::vector<pipeline::ResolvedSetting> settings() const;

  /// Begins again with another configuration at frame `origin`.
  void restart(const pipeline::PresetRequest& request, std::size_t origin);

  /// Writes the estimate up to the frame on show into `folder`: trajectory.tum, map.ply and, with
  /// a reference, reference.tum.
  void save(const std::filesystem::path& folder);

 private:
  void seek_again() TRAVERSE_REQUIRES(mutex_);
  void estimate();
  void build_index();
  bool work_once(double seconds);
  bool frame_passed(const SessionFrame& frame, std::size_t target);
  void remember(const SessionFrame& frame);
  void publish();
  void begin(const pipeline::PresetRequest& request, std::size_t origin);
  void write(const std::filesystem::path& folder);
  void fail(const std::string& what);
  void do_later(std::function<void()> job);

  Recording recording_;
  PlayerOptions options_;
  std::unique_ptr<Session> session_;  // of the estimating thread alone, like the next one
  std::chrono::steady_clock::time_point last_published_{};

  mutable parallel::Mutex mutex_;  // held for moments only
  parallel::Condition changed_;
  std::vector<std::string> columns_ TRAVERSE_GUARDED_BY(mutex_);
  Controls controls_ TRAVERSE_GUARDED_BY(mutex_);
  Timeline timeline_ TRAVERSE_GUARDED_BY(mutex_);
  /// A place asked for that the index has not come to.
  std::optional<std::string> ahead_ TRAVERSE_GUARDED_BY(mutex_);
  std::vector<FrameIndex::Skipped> skipped_ TRAVERSE_GUARDED_BY(mutex_);
  std::vector<pipeline::ResolvedSetting> settings_ TRAVERSE_GUARDED_BY(mutex_);
  std::vector<PastFrame> past_ TRAVERSE_GUARDED_BY(mutex_);
  std::optional<geometry::Pose3> T_map_reference_ TRAVERSE_GUARDED_BY(mutex_);
  std::shared_ptr<const Shown> shown_ TRAVERSE_GUARDED_BY(mutex_);
  std::deque<std::function<void()>> jobs_ TRAVERSE_GUARDED_BY(mutex_);
  bool has_job_ TRAVERSE_GUARDED_BY(mutex_) = false;  // at work
  PlayerStatus status_ TRAVERSE_GUARDED_BY(mutex_);

  mutable parallel::Mutex map_mutex_;
  MapHistory map_ TRAVERSE_GUARDED_BY(map_mutex_);

  std::atomic<bool> stop_{false};
  std::thread estimating_;
  std::thread indexing_;
};

}  // namespace traverse::replay
