#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <vector>

#include "traverse/dataset/source.hpp"
#include "traverse/pipeline/estimator.hpp"

namespace traverse::replay {

/// All that the work on a recording depends on, between two frames. Copies are independent.
struct State {
  State() = default;
  State(const State& other);
  State& operator=(const State&) = delete;
  State(State&&) = default;
  State& operator=(State&&) = default;
  ~State() = default;

  std::size_t next_frame = 0;  ///< number of the frame that comes next
  std::unique_ptr<pipeline::Estimator> estimator;
  std::deque<sensors::Measurement> waiting;  ///< scans fed, whose frames are not known yet
  std::deque<pipeline::PoseFrame> ready;     ///< frames known, but not shown
  bool finished = false;                     ///< the recording is through

  std::size_t bytes() const;  ///< of memory, about; a scan counts for each state that waits for it
};

/// A state and the place of the recording that it goes on from.
struct Checkpoint {
  State state;
  std::shared_ptr<const dataset::Bookmark> place;  ///< null: read from the beginning ...
  std::size_t measurements = 0;                    ///< ... and pass over so many
};

/// Checkpoints along the way, bounded in number and in bytes: dense near the present frame, where
/// steps back are likely, and ever farther apart away from it. The first and the newest are never
/// dropped.
class Checkpoints {
 public:
  static constexpr std::size_t kMost = 24;
  static constexpr std::size_t kMostBytes = 512UL << 20;

  explicit Checkpoints(std::size_t max_bytes = kMostBytes) : max_bytes_(max_bytes) {}

  bool has(std::size_t frame) const { return by_frame_.count(frame) != 0; }
  std::size_t size() const { return by_frame_.size(); }
  std::size_t bytes() const { return bytes_; }  ///< of all, about
  std::vector<std::size_t> frames() const;
  void clear();

  /// Keeps a checkpoint from which `checkpoint.state.next_frame` is the next.
  void add(Checkpoint checkpoint);

  /// The last one from which `frame` is still to come; null if there is none.
  const Checkpoint* before(std::size_t frame) const;

 private:
  struct Kept {
    Checkpoint checkpoint;
    std::size_t bytes;
  };

  bool drop_one(std::size_t present_frame);

  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::map<std::size_t, Kept> by_frame_;
};

}  // namespace traverse::replay
