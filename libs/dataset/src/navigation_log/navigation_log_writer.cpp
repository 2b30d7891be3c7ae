#include <cmath>
#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "traverse/dataset/recording_writer.hpp"
#include "traverse/files/numbers.hpp"

#include "recording/recording_files.hpp"
#include "recording/sidecar.hpp"

namespace traverse::dataset {

namespace {

namespace fs = std::filesystem;
using sensors::SensorKind;

std::string text_of(const Eigen::Vector3d& v) {
  return files::to_text(v.x()) + " " + files::to_text(v.y()) + " " + files::to_text(v.z());
}

class NavigationLogWriter final : public RecordingWriter {
 public:
  NavigationLogWriter(const fs::path& file, const RecordingInfo& info,
                      const std::optional<Reference>& reference, const FilesThere& there)
      : files_(RecordingFiles::beside(file, there)), output_(files_.add_data()), info_(info) {
    output_.stream() << "# IMU t gx gy gz ax ay az; ODOM t left right; GNSS t lat lon alt heading "
                        "heading_valid\n";
    if (reference) sidecar_.reference = reference->T_map_body;
  }

  void add(const sensors::Measurement& measurement) override {
    std::visit([this](const auto& held) { write(held); }, measurement);
  }

  void add_file(const std::string& name, const std::string& text) override {
    files_.write(name, text);
  }

  void commit() override {
    sidecar_.name = info_.name;
    sidecar_.body_frame = info_.rig.body_frame;
    sidecar_.vehicle = vehicle_statements_of(info_.rig);
    sidecar_.log = {AngularUnit::kRadians, PulseCount::kCumulative, 1};
    commit_with_sidecar(sidecar_, files_);
  }

 private:
  void write(const sensors::ImuSample& sample) {
    if (is_another(SensorKind::kImu, sample.sensor, "samples of another IMU")) return;
    output_.stream() << "IMU " << geometry::to_text(sample.stamp) << " "
                     << text_of(sample.angular_rate) << " " << text_of(sample.specific_force)
                     << "\n";
  }

  void write(const sensors::WheelOdometry& reading) {
    if (is_another(SensorKind::kWheels, reading.sensor, "readings of other wheels")) return;
    if (!reading.ticks) {
      ++left_out_["wheel readings without pulses"];
      return;
    }
    output_.stream() << fmt::format("ODOM {} {} {}\n", geometry::to_text(reading.stamp),
                                    reading.ticks->left, reading.ticks->right);
  }

  void write(const sensors::GnssFix& fix) {
    if (is_another(SensorKind::kGnss, fix.sensor, "fixes of another receiver")) return;
    if (std::isnan(fix.altitude_m)) {
      ++left_out_["fixes without an altitude"];
      return;
    }
    if (fix.covariance_enu) ++left_out_["deviations of fixes"];
    output_.stream() << fmt::format(
        "GNSS {} {} {} {} {} {}\n", geometry::to_text(fix.stamp), files::to_text(fix.latitude_deg),
        files::to_text(fix.longitude_deg), files::to_text(fix.altitude_m),
        files::to_text(fix.heading_deg.value_or(0)), fix.heading_deg ? 1 : 0);
  }

  template <typename Scan>
  void write(const std::shared_ptr<const Scan>&) {
    ++left_out_["laser scans"];
  }

  bool is_another(SensorKind kind, const std::string& label, const char* what) {
    const auto* first = info_.rig.first(kind);
    if (first == nullptr || first->label == label) return false;
    ++left_out_[what];
    return true;
  }

  RecordingFiles files_;
  files::AtomicFile& output_;
  const RecordingInfo& info_;
  Sidecar sidecar_;
};

}  // namespace

std::unique_ptr<RecordingWriter> write_navigation_log(const fs::path& file,
                                                      const RecordingInfo& info,
                                                      const std::optional<Reference>& reference,
                                                      const FilesThere& there) {
  return std::make_unique<NavigationLogWriter>(file, info, reference, there);
}

}  // namespace traverse::dataset
