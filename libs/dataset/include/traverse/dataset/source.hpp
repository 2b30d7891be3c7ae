#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "traverse/geometry/pose3.hpp"
#include "traverse/geometry/trajectory.hpp"
#include "traverse/sensors/measurement.hpp"
#include "traverse/sensors/rig.hpp"

namespace traverse::dataset {

/// Something that was taken for true about a recording, and why: shown by `info` and the report.
struct Fact {
  std::string name;    ///< "motion compensated"
  std::string value;   ///< "no"
  std::string reason;  ///< "traverse.yaml, line 3" | "KITTI raw scans are not" | "--recording ..."
};

/// The name of facts about files that lie beside a recording and may be meant for it, but are not
/// used: what they are, and as the reason the option that takes them.
inline constexpr const char* kNotUsed = "not used";
/// Whether `fact` tells of a clock that was set while the recording was made, or of a pause.
bool is_clock_step(const Fact& fact);

/// Records that could not be used, by reason, with the first few places of each.
class SkippedRecords {
 public:
  void add(const std::string& reason, const std::string& place);

  std::size_t total() const;
  bool empty() const { return by_reason_.empty(); }

  struct Count {
    std::size_t count = 0;
    std::vector<std::string> first_places;  ///< at most ten, "velodyne/000012.bin", "record 340"
  };
  const std::map<std::string, Count>& by_reason() const { return by_reason_; }

 private:
  std::map<std::string, Count> by_reason_;
};

/// A topic of a recording that has many, and what becomes of it.
struct TopicInfo {
  std::string topic;
  std::string type;
  std::uint64_t count = 0;  ///< messages
  double rate_hz = 0;       ///< over the whole recording; 0 for fewer than two
  std::string use;          ///< "lidar", "transforms"; empty: none
  std::string why;          ///< it is used, or not
};

/// What a recording is, known before its measurements are read.
struct RecordingInfo {
  std::filesystem::path path;
  std::string format;  ///< "KITTI odometry", "KITTI raw", "point-cloud folder", "MRPT rawlog"
  std::string name;    ///< short, for titles: "2011_09_26_drive_0001"
  /// A rawlog names its sensors as it goes: those that appear late join while it is read.
  sensors::Rig rig;
  /// Camera 0 (rectified), in which the KITTI metric is computed; nothing if it is not known.
  std::optional<geometry::Pose3> T_body_camera;
  /// The points of each scan already lie where they would at the scan's stamp: no deskew.
  bool motion_compensated = false;
  std::vector<Fact> facts;
  /// Number of measurements of each lidar scan stream, when it is known without reading; 0 if not.
  std::size_t expected_scans = 0;
  /// Label of the receiver whose fixes the reference is made of: an estimate that takes them too
  /// cannot be judged by it. Empty: none.
  std::string reference_receiver = {};
  /// Why a reference that stands where the format has it is not used: a file, what was expected in
  /// it and what was found. Empty: there is none, or it is used.
  std::string reference_refused = {};
  /// Codes of contradictions that the user knows of and goes on with (statement `accept`).
  std::vector<std::string> accepted_contradictions = {};
  /// Of recordings that have many: all, in the order of the recording.
  std::vector<TopicInfo> topics = {};
  /// Whether the recording tells by itself what it holds, so that it need not be read for that.
  bool is_listed = false;
};

/// The reference trajectory that belongs to a recording.
struct Reference {
  geometry::Trajectory T_map_body;  ///< in the rig's body frame, stamped
  std::filesystem::path file;
  std::string description;  ///< how it was brought to the body frame
  /// Unit vector to true north in the map frame, when the reference is tied to the earth.
  std::optional<Eigen::Vector3d> north_map = std::nullopt;
};

/// A place in a recording to come back to; each source knows its own kind.
class Bookmark {
 public:
  virtual ~Bookmark() = default;
};

/// A recording: a stream of measurements in the order of their stamps.
///
/// A record that cannot be used is skipped and counted when the rest is usable; an input that
/// cannot be used at all is a files::InputError.
class Source {
 public:
  virtual ~Source() = default;

  virtual const RecordingInfo& info() const = 0;

  /// The next measurement, or nothing at the end. Stamps never decrease within one sensor: a
  /// record whose stamp is not later than its predecessor's is skipped and counted.
  virtual std::optional<sensors::Measurement> next() = 0;

  /// Begins again from the first measurement, with no record skipped yet.
  virtual void rewind() = 0;

  /// Records skipped so far.
  virtual const SkippedRecords& skipped() const = 0;

  /// The reference trajectory, if the recording has one.
  virtual const std::optional<Reference>& reference() const = 0;

  /// How much of the recording next() has been through, 0 to 1, for a progress bar; nothing if
  /// that is not known.
  virtual std::optional<double> share_read() const { return std::nullopt; }

  /// Where next() stands; null if this source can only rewind(). Small: of what has been read only
  /// what waits to come out is kept.
  virtual std::shared_ptr<const Bookmark> bookmark() const { return nullptr; }

  /// Goes on from a bookmark that this source made: next() gives what it gave then, skipped()
  /// counts what it counted.
  virtual void return_to(const Bookmark& bookmark);

  /// The stamps of the first lidar's scans in order, where the recording tells without its scans
  /// being read; nothing else. A scan that turns out to be unusable is among them.
  virtual std::optional<std::vector<geometry::Stamp>> listed_scan_stamps() const {
    return std::nullopt;
  }
};

}  // namespace traverse::dataset
