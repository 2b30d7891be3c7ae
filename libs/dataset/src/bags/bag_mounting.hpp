#pragma once

#include <optional>
#include <string>

#include "traverse/bags/message_container.hpp"
#include "traverse/dataset/source.hpp"

#include "bags/frame_tree.hpp"
#include "bags/topic_choice.hpp"
#include "recording/statements.hpp"

namespace traverse::dataset {

/// Where the sensors of a bag are, by its transforms: in the frame that is stated as body_frame,
/// else in base_link, base_footprint or the IMU's, whichever the lidar is linked to first, else in
/// the lidar's.
class BagMounting {
 public:
  /// Sets the body frame of `info`, which must outlive this, as must `frames`.
  BagMounting(const FrameTree& frames, const Statements& statements, const std::string& lidar_frame,
              const std::string& imu_frame, RecordingInfo& info);

  /// T_body_sensor; a fact tells whence it is, or what follows from a link that is missing.
  geometry::Pose3 place(sensors::SensorKind kind, const PeekedTopic& topic);

 private:
  const FrameTree& frames_;
  RecordingInfo& info_;
  std::string body_;  ///< its frame
};

/// The poses of a topic as the reference, in the body frame.
/// \throws files::InputError if there are no poses
Reference reference_of_topic(bags::MessageContainer& container, const PeekedTopic& topic,
                             const FrameTree& frames, const geometry::Pose3& T_body_lidar,
                             const Statements& statements, RecordingInfo& info);

}  // namespace traverse::dataset
