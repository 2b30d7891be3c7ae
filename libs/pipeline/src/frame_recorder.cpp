#include "frame_recorder.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <utility>

#include "traverse/pipeline/imported_poses.hpp"

namespace traverse::pipeline {

namespace {

constexpr std::size_t kFramesTogether = 5;  // a worst segment of ten frames holds five in a row
constexpr std::size_t kMostScanPoints = 6000;
constexpr std::size_t kMostMatches = 2500;
constexpr std::size_t kValuesOfPoint = 3;
constexpr std::size_t kValuesOfMatch = 8;  // position, offset, residual, kind

/// What worst_frames.ply says of a point.
enum class Kind : std::uint8_t { kScan, kOnLine, kOnPlane };

/// Calls `use` with at most `most` of the numbers 0 to `count` - 1, evenly spread.
template <typename Use>
void for_each_spread(std::size_t count, std::size_t most, const Use& use) {
  const std::size_t kept = std::min(count, most);
  for (std::size_t k = 0; k < kept; ++k) use(k * count / kept);
}

void append(const Eigen::Vector3d& v, std::vector<float>& values) {
  for (int axis = 0; axis < 3; ++axis) values.push_back(static_cast<float>(v[axis]));
}

/// The columns of worst_frames.ply.
class Columns {
 public:
  /// What is added from now on is of this frame.
  void begin(std::size_t frame, const geometry::Pose3& T_map_body) {
    number_ = static_cast<std::uint32_t>(frame);
    T_map_body_ = T_map_body;
  }
  /// \param p_body its three values
  void add_scan_point(const float* p_body) {
    add(Kind::kScan, T_map_body_ * vector_at(p_body), Eigen::Vector3d::Zero(), 0);
  }
  /// \param row of kValuesOfMatch
  void add_match(const float* row) {
    add(row[7] != 0 ? Kind::kOnLine : Kind::kOnPlane, T_map_body_ * vector_at(row),
        T_map_body_.rotation * vector_at(row + 3), row[6]);
  }

  dataset::PointCloud take() {
    dataset::PointCloud cloud;
    cloud.add("frame", std::move(frame_));
    for (std::size_t axis = 0; axis < 3; ++axis) cloud.add(kAxes[axis], std::move(position_[axis]));
    cloud.add("kind", std::move(kind_));
    cloud.add("residual_m", std::move(residual_m_));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      cloud.add(std::string("offset_") + kAxes[axis], std::move(offset_[axis]));
    }
    return cloud;
  }

 private:
  static constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};

  static Eigen::Vector3d vector_at(const float* values) {
    return Eigen::Map<const Eigen::Vector3f>(values).cast<double>();
  }

  void add(Kind kind, const Eigen::Vector3d& p_map, const Eigen::Vector3d& offset_map,
           float residual_m) {
    frame_.push_back(number_);
    kind_.push_back(static_cast<std::uint8_t>(kind));
    residual_m_.push_back(residual_m);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      position_[axis].push_back(static_cast<float>(p_map[static_cast<Eigen::Index>(axis)]));
      offset_[axis].push_back(static_cast<float>(offset_map[static_cast<Eigen::Index>(axis)]));
    }
  }

  std::uint32_t number_ = 0;
  geometry::Pose3 T_map_body_;
  std::vector<std::uint32_t> frame_;
  std::vector<std::uint8_t> kind_;
  std::array<std::vector<float>, 3> position_;
  std::array<std::vector<float>, 3> offset_;
  std::vector<float> residual_m_;
};

}  // namespace

FrameRecorder::FrameRecorder(const std::filesystem::path& folder, const Estimator& estimator)
    : estimator_(estimator), is_foreign_(estimator.foreign().has_value()), scratch_(folder) {
  const auto& columns = estimator.columns();
  const auto found = std::find(columns.begin(), columns.end(), "residual_rms_m");
  if (found != columns.end()) {
    residual_column_ = static_cast<std::size_t>(found - columns.begin());
  }
}

bool FrameRecorder::wants(std::size_t pose, const PoseFrame& frame) const {
  // Of poses that another program made one of five is as good as another.
  if (!residual_column_) return is_foreign_ && pose % kFramesTogether == kFramesTogether / 2;
  if (!pending_ || pose / kFramesTogether != pending_->pose / kFramesTogether) return true;
  return frame.record[*residual_column_] > pending_->residual_rms_m;
}

void FrameRecorder::add(std::size_t pose, const PoseFrame& frame, const UsedScan& used) {
  if (pending_ && pose / kFramesTogether != pending_->pose / kFramesTogether) keep_pending();
  const double residual_rms_m = residual_column_ ? frame.record[*residual_column_] : 0;
  const geometry::Pose3 T_body_map = frame.T_map_body.inverse();

  pending_values_.clear();
  for_each_spread(used.x.size(), kMostScanPoints, [&](std::size_t i) {
    append(Eigen::Vector3d(used.x[i], used.y[i], used.z[i]), pending_values_);
  });
  const std::size_t scan_points = pending_values_.size() / kValuesOfPoint;
  const std::vector<MatchedPoint> matches = estimator_.matches();
  for_each_spread(matches.size(), kMostMatches, [&](std::size_t i) {
    const MatchedPoint& match = matches[i];
    append(T_body_map * match.p_map, pending_values_);
    append(T_body_map.rotation * (match.p_map - match.foot_map), pending_values_);
    pending_values_.push_back(static_cast<float>(match.residual_m));
    pending_values_.push_back(match.on_line ? 1 : 0);
  });
  pending_ = {pose, residual_rms_m, scan_points, std::min(matches.size(), kMostMatches), 0};
}

void FrameRecorder::keep_pending() {
  if (!pending_) return;
  pending_->offset = scratch_.append(std::as_bytes(std::span(pending_values_)));
  entries_.push_back(*pending_);
  pending_.reset();
}

const FrameRecorder::Entry* FrameRecorder::worst_in(const evaluation::WorstSegment& segment) const {
  const Entry* worst = nullptr;
  for (const Entry& entry : entries_) {
    // The errors of a motion are made after its first frame.
    if (entry.pose <= segment.first || entry.pose > segment.last) continue;
    if (worst == nullptr || entry.residual_rms_m > worst->residual_rms_m) worst = &entry;
  }
  return worst;
}

std::vector<float> FrameRecorder::values_of(const Entry& entry) const {
  std::vector<float> values(kValuesOfPoint * entry.scan_points + kValuesOfMatch * entry.matches);
  scratch_.read(entry.offset, std::as_writable_bytes(std::span(values)));
  return values;
}

dataset::PointCloud FrameRecorder::worst_frames(const evaluation::WorstSegments& worst,
                                                const geometry::Trajectory& T_map_body,
                                                std::size_t first_frame) {
  keep_pending();
  Columns columns;
  for (const evaluation::WorstSegment& segment : worst.segments) {
    const Entry* entry = worst_in(segment);
    if (entry == nullptr) continue;
    const std::vector<float> values = values_of(*entry);
    columns.begin(first_frame + entry->pose, T_map_body.pose(entry->pose));
    const float* at = values.data();
    for (std::size_t k = 0; k < entry->scan_points; ++k, at += kValuesOfPoint) {
      columns.add_scan_point(at);
    }
    for (std::size_t k = 0; k < entry->matches; ++k, at += kValuesOfMatch) {
      columns.add_match(at);
    }
  }
  return columns.take();
}

}  // namespace traverse::pipeline
