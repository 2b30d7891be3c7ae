#include "traverse/replay/frame_index.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <variant>

#include <nlohmann/json.hpp>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/digest.hpp"
#include "traverse/files/json_document.hpp"

#include "frame_sensor.hpp"

namespace traverse::replay {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::size_t kVersion = 1;
constexpr std::uintmax_t kPieces = 64;
constexpr std::uintmax_t kPieceBytes = 64 << 10;

/// Notes reasons that are new or whose count grew since the last frame.
void note_skipped(const dataset::SkippedRecords& skipped, FrameIndex& index) {
  for (const auto& [reason, count] : skipped.by_reason()) {
    const std::string& name = reason;
    const auto known = std::find_if(index.skipped.begin(), index.skipped.end(),
                                    [&](const auto& entry) { return entry.reason == name; });
    if (known != index.skipped.end()) {
      known->count = count.count;
    } else {
      index.skipped.push_back({reason, count.count, index.frames.size()});
    }
  }
}

}  // namespace

std::optional<FrameIndex> build_index(dataset::Source& source, const std::string& frame_sensor,
                                      const IndexObserver& observer) {
  FrameIndex index;
  source.rewind();
  std::size_t skipped = 0;
  const auto note = [&] {
    if (source.skipped().total() == skipped) return;
    skipped = source.skipped().total();
    note_skipped(source.skipped(), index);
  };
  while (const auto measurement = source.next()) {
    if (observer.stop != nullptr && *observer.stop) return std::nullopt;
    note();
    if (!is_frame(*measurement, frame_sensor)) continue;
    index.frames.push_back(sensors::stamp_of(*measurement));
    observer.frame(index.frames.back());
    observer.progress(source.share_read().value_or(0));
  }
  note();
  return index;
}

std::optional<fs::path> index_file(const fs::path& recording) {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  if (cache == nullptr && home == nullptr) return std::nullopt;
  const fs::path folder = cache != nullptr ? fs::path(cache) : fs::path(home) / ".cache";
  const std::string place = fs::weakly_canonical(recording).string();
  return folder / "traverse" /
         (recording.stem().string() + "-" + files::sha256_of_text(place).substr(0, 16) +
          ".index.json");
}

std::string quick_digest(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::uintmax_t bytes = fs::file_size(file);
  std::string sample = std::to_string(bytes) + "\n";
  std::string piece(kPieceBytes, '\0');
  const std::uintmax_t last = bytes > kPieceBytes ? bytes - kPieceBytes : 0;
  for (std::uintmax_t k = 0; k < kPieces; ++k) {
    stream.clear();
    stream.seekg(static_cast<std::streamoff>(last / (kPieces - 1) * k));
    if (k + 1 == kPieces) stream.seekg(static_cast<std::streamoff>(last));
    stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    sample.append(piece, 0, static_cast<std::size_t>(stream.gcount()));
    if (last == 0) break;
  }
  return files::sha256_of_text(sample);
}

std::optional<FrameIndex> load_index(const fs::path& file, const std::string& digest,
                                     const std::string& frame_sensor) {
  try {
    const auto document = files::JsonDocument::read(file);
    const files::JsonValue json = document.root();
    if (json["version"].count() != kVersion || json["digest"].text() != digest ||
        json["frame_sensor"].text() != frame_sensor) {
      return std::nullopt;
    }
    FrameIndex index;
    for (const std::int64_t stamp : json["frames"].integers()) index.frames.push_back({stamp});
    const files::JsonValue skipped = json["skipped"];
    for (std::size_t i = 0; i < skipped.size(); ++i) {
      index.skipped.push_back({skipped[i]["reason"].text(), skipped[i]["count"].count(),
                               skipped[i]["first_behind_frames"].count()});
    }
    return index;
  } catch (const files::InputError&) {
    return std::nullopt;  // not one of ours, or of another version: it is made again
  }
}

void save_index(const fs::path& file, const std::string& digest, const std::string& frame_sensor,
                const FrameIndex& index) {
  Json json{{"version", kVersion}, {"digest", digest}, {"frame_sensor", frame_sensor}};
  Json& frames = json["frames"] = Json::array();
  for (const geometry::Stamp stamp : index.frames) frames.push_back(stamp.nanoseconds);
  Json& skipped = json["skipped"] = Json::array();
  for (const auto& entry : index.skipped) {
    skipped.push_back({{"reason", entry.reason},
                       {"count", entry.count},
                       {"first_behind_frames", entry.first_behind_frames}});
  }
  files::make_writable_folder(file.parent_path());
  files::write_text(file, json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace traverse::replay
