#include "recording_progress.hpp"

#include <filesystem>

namespace traverse::app {

namespace {

constexpr std::uintmax_t kBytesPerMegabyte = 1'000'000;

/// 0 when progress is counted in scans.
std::size_t megabytes_of(const dataset::Source& source) {
  const std::filesystem::path& path = source.info().path;
  if (source.info().expected_scans > 0 || !std::filesystem::is_regular_file(path)) return 0;
  return static_cast<std::size_t>(std::filesystem::file_size(path) / kBytesPerMegabyte) + 1;
}

}  // namespace

RecordingProgress::RecordingProgress(const std::string& verb, const dataset::Source& source)
    : source_(source),
      megabytes_(megabytes_of(source)),
      bar_(verb + " " + source.info().name,
           megabytes_ > 0 ? megabytes_ : source.info().expected_scans,
           megabytes_ > 0 ? "MB" : "scans") {}

void RecordingProgress::update(const sensors::Measurement& measurement) {
  const bool is_scan =
      std::holds_alternative<std::shared_ptr<const sensors::LidarScan>>(measurement);
  scans_ += is_scan ? 1 : 0;
  bar_.update(megabytes_ > 0 ? static_cast<std::size_t>(source_.share_read().value_or(0) *
                                                        static_cast<double>(megabytes_))
                             : scans_);
}

}  // namespace traverse::app
