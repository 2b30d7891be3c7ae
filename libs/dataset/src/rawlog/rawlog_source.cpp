#include "rawlog/rawlog_source.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"
#include "traverse/mrpt_io/rawlog_reader.hpp"

#include "rawlog/named_points.hpp"
#include "rawlog/rawlog_converter.hpp"
#include "rawlog/rawlog_sensors.hpp"
#include "recording/arrival_queue.hpp"
#include "recording/folder_opening.hpp"
#include "recording/unused_files.hpp"

namespace traverse::dataset {

using sensors::Measurement;

namespace {

namespace fs = std::filesystem;

/// How much is read ahead to learn which sensors there are.
constexpr std::uint64_t kPreviewBytes = 64 << 20;
constexpr std::size_t kPreviewRecords = 2000;

fs::path sidecar_of(const fs::path& file) {
  return fs::path(file).replace_extension(".traverse.yaml");
}

/// Where a rawlog keeps what is too large for it, as MRPT's tools name it. (MRPT's own
/// detectImagesDirectory() forgets a slash in version 2.5.8.)
std::string external_folder_of(const fs::path& file) {
  const std::string stem = file.stem().string();
  for (const std::string& name : {stem + "_Images", stem + "_images", std::string("Images")}) {
    if (fs::is_directory(file.parent_path() / name)) return (file.parent_path() / name).string();
  }
  return (file.parent_path() / (stem + "_Images")).string();
}

struct RawlogBookmark : Bookmark {
  mrpt_io::RawlogReader::Position position;
  RawlogConverter::State converter;
  ArrivalQueue queue;
};

class RawlogSource : public Source {
 public:
  RawlogSource(const fs::path& file, const OpenOptions& options, std::string_view format)
      : file_(file),
        statements_(sidecar_of(file), options, file.parent_path()),
        external_folder_(external_folder_of(file)),
        info_(begin_info(file, format, statements_, "vehicle")),
        sensors_(statements_, options.share_folder, info_),
        named_points_(file, external_folder_, statements_, info_),
        reader_(std::make_unique<mrpt_io::RawlogReader>(file)),
        converter_(std::in_place, sensors_, named_points_, external_folder_) {
    set_motion_compensation(info_, statements_, false, "default, not stated");
    preview();
    set_camera(info_, statements_, {});
    const auto* lidar = info_.rig.first(sensors::SensorKind::kLidar);
    if (lidar != nullptr && info_.T_body_camera) {
      info_.T_body_camera = lidar->T_body_sensor * *info_.T_body_camera;
    }
    reference_ = load_stated_reference(lidar);
    note_unused_files(info_, options, reference_, 0);
    rewind();
  }

  const RecordingInfo& info() const override { return info_; }
  const SkippedRecords& skipped() const override { return queue_.skipped(); }
  const std::optional<Reference>& reference() const override { return reference_; }
  std::optional<double> share_read() const override { return reader_->share_read(); }

  std::optional<Measurement> next() override {
    return queue_.next([&] { read_record(); });
  }

  void rewind() override {
    reader_ = std::make_unique<mrpt_io::RawlogReader>(file_);
    converter_.emplace(sensors_, named_points_, external_folder_);
    queue_ = ArrivalQueue();
  }

  std::shared_ptr<const Bookmark> bookmark() const override {
    auto here = std::make_shared<RawlogBookmark>();
    here->position = reader_->position();
    here->converter = converter_->state();
    here->queue = queue_;
    return here;
  }

  void return_to(const Bookmark& bookmark) override {
    const auto& there = dynamic_cast<const RawlogBookmark&>(bookmark);
    reader_->return_to(there.position);
    converter_->set_state(there.converter);
    queue_ = there.queue;
  }

 private:
  void read_record() {
    const auto record = reader_->next();
    if (!record) {
      queue_.finish();
      queue_.note_steps(info_.facts);
      if (reader_->fault()) queue_.skipped().add(reader_->fault()->reason, reader_->fault()->place);
      return;
    }
    ConvertedRecord converted = converter_->convert(*record);
    for (auto& skipped : converted.skipped) queue_.skipped().add(skipped.reason, skipped.place);
    for (Measurement& measurement : converted.measurements) {
      queue_.push(std::move(measurement), record->place);
    }
    queue_.note_steps(info_.facts);
  }

  /// Reads the beginning, so that info() knows the sensors.
  void preview() {
    while (!queue_.is_finished() && reader_->bytes_read() < kPreviewBytes &&
           reader_->records_read() < kPreviewRecords) {
      read_record();
      queue_.drop_waiting();
    }
    if (queue_.is_finished() && info_.rig.sensors.empty()) {
      std::string found = "none of these";
      for (const auto& [reason, count] : queue_.skipped().by_reason()) {
        found += fmt::format("; {} x {}", count.count, reason);
      }
      throw files::InputError(file_, files::Place::whole_file(),
                              "observations of a laser, an IMU, a GNSS receiver or wheels", found);
    }
  }

  std::optional<Reference> load_stated_reference(const sensors::MountedSensor* lidar) {
    const auto file = stated_reference(statements_);
    if (!file) return std::nullopt;
    const geometry::Pose3 T_body_lidar =
        lidar != nullptr ? lidar->T_body_sensor : geometry::Pose3::identity();
    return load_reference(*file, {T_body_lidar, info_.T_body_camera}, {}, info_.facts);
  }

  fs::path file_;
  Statements statements_;
  std::string external_folder_;
  RecordingInfo info_;
  RawlogSensors sensors_;
  NamedPoints named_points_;
  std::optional<Reference> reference_;

  std::unique_ptr<mrpt_io::RawlogReader> reader_;
  std::optional<RawlogConverter> converter_;
  ArrivalQueue queue_;
};

}  // namespace

std::unique_ptr<Source> open_rawlog(const fs::path& file, const OpenOptions& options,
                                    std::string_view format) {
  return std::make_unique<RawlogSource>(file, options, format);
}

}  // namespace traverse::dataset
