#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "traverse/dataset/source.hpp"
#include "traverse/pipeline/estimator.hpp"
#include "traverse/replay/checkpoints.hpp"

namespace traverse::replay {

/// A frame with the measurement that it belongs to.
struct SessionFrame {
  std::size_t number = 0;  ///< counted from 0 in the recording
  pipeline::PoseFrame pose;
  std::optional<sensors::Measurement> scan;  ///< nothing if the estimator's frame is not a scan's
};

/// An estimator at work on a recording that can be asked for any frame in any order. Behind each
/// frame the estimator's state is the one it has when the recording is simply played: going back
/// restores a checkpoint and estimates again.
class Session {
 public:
  /// \param frame_sensor whose measurements are counted as frames
  /// \param origin the frame that the estimator begins with
  Session(std::unique_ptr<dataset::Source> source, std::unique_ptr<pipeline::Estimator> estimator,
          std::string frame_sensor, std::size_t origin = 0);

  /// Begins again at frame `origin` with another estimator; nothing of the old one is kept.
  void restart(std::unique_ptr<pipeline::Estimator> estimator, std::size_t origin);

  enum class Outcome {
    kThere,    ///< frame() is the one asked for
    kStopped,  ///< `passed` said so
    kEnd,      ///< the recording has fewer frames; frame() is the last one, if there is any
  };

  /// Goes to a frame, not before origin(). \param passed is called with every frame on the way, the
  /// last one too, and ends the way by returning false
  /// \throws what reading and estimating throw
  Outcome go_to(std::size_t number, const std::function<bool(const SessionFrame&)>& passed);

  /// Where go_to() last came to, with the estimator as it is there; nothing before the first frame.
  const std::optional<SessionFrame>& frame() const { return frame_; }
  const pipeline::Estimator& estimator() const { return *state_.estimator; }
  /// Whether frame() is the newest that the estimator knows. Behind a start that was held back it
  /// is ahead for a few frames, and its matches are those of another scan.
  bool estimator_is_at_frame() const { return frame_ && state_.ready.empty(); }
  const dataset::Source& source() const { return *source_; }

  std::size_t origin() const { return origin_; }
  const Checkpoints& checkpoints() const { return checkpoints_; }

 private:
  bool advance();
  void feed(const sensors::Measurement& measurement);
  void go_to_origin();
  void keep_checkpoint();
  void return_to(const Checkpoint& checkpoint);
  bool is_wanted_checkpoint(std::size_t target) const;

  std::unique_ptr<dataset::Source> source_;
  std::string frame_sensor_;
  std::size_t origin_ = 0;
  std::size_t measurements_ = 0;  // read from the source since its beginning
  State state_;
  std::optional<SessionFrame> frame_;
  Checkpoints checkpoints_;
};

}  // namespace traverse::replay
