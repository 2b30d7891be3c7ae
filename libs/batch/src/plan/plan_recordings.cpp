#include "plan/plan_recordings.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <glob.h>

#include "traverse/files/input_error.hpp"

#include "plan/plan_error.hpp"
#include "plan/plan_parts.hpp"

namespace traverse::batch {

namespace {

namespace fs = std::filesystem;
using config::Binder;
using config::Document;
using config::Origin;

/// An entry of the list as it is written.
struct Entry {
  PlannedRecording recording;
  std::string path;
  std::string world;
  std::vector<double> seeds;
};

fs::path absolute_below(const fs::path& folder, const std::string& path) {
  return (folder / path).lexically_normal();
}

/// Files that plans name and that are not there. All are told at once.
struct Missing {
  Origin origin;
  std::string what;
  fs::path path;
};

/// \throws files::InputError with the place of the first
void require_none(const std::vector<Missing>& missing) {
  if (missing.empty()) return;
  constexpr std::size_t kMostNamed = 20;
  // Whole, unlike files::in_quotes(): of a long path the end tells.
  std::string found = fmt::format("'{}'", missing.front().path.string());
  for (std::size_t i = 1; i < std::min(missing.size(), kMostNamed); ++i) {
    found += fmt::format("{} '{}'", i == 1 ? "; nor are there" : ",", missing[i].path.string());
  }
  if (missing.size() > kMostNamed)
    found += fmt::format(" and {} more", missing.size() - kMostNamed);
  throw plan_error(missing.front().origin, missing.front().what, found);
}

/// {length: 60, quiet: true} as the words --length 60 --quiet.
std::vector<std::string> option_words(const Document& options) {
  std::vector<std::string> words;
  for (const config::Leaf& leaf : options.leaves()) {
    const std::string value = options.scalar(leaf.path).value_or(leaf.text);
    if (value == "false") continue;
    words.push_back("--" + leaf.path);
    if (value != "true") words.push_back(value);
  }
  return words;
}

/// A file that the entry names under `key`, which must be there.
fs::path existing_file(const Document& entry, std::string_view key, const std::string& name,
                       const fs::path& folder, std::vector<Missing>& missing) {
  if (name.empty()) return {};
  fs::path file = absolute_below(folder, name);
  if (!fs::is_regular_file(file)) {
    missing.push_back({*entry.origin(key), "a file that is there", file});
  }
  return file;
}

Entry read_entry(const Document& document, const fs::path& folder, std::vector<Missing>& missing) {
  Entry entry;
  PlannedRecording& recording = entry.recording;
  recording.origin = document.origin();
  std::string config_file;
  std::string reference;
  std::string checkpoints;
  static constexpr std::array<std::string_view, 4> kFrames{"", "body", "lidar", "camera"};
  static constexpr std::array<std::string_view, 3> kOthers{"statements", "arguments", "pipelines"};
  config::read(
      document,
      [&](Binder& b) {
        b.text("path", entry.path, "of the recording, or a glob");
        b.text("simulate", entry.world, "world that `traverse simulate` makes it of, with options");
        b.numbers("seeds", entry.seeds, "one generated recording per seed");
        b.text("text", recording.text, "above its tables");
        b.text("name", recording.name, "in tables");
        b.text("config", config_file, "statements about the recording");
        b.text("reference", reference, "reference trajectory");
        b.word("reference_frame", recording.reference_frame, kFrames,
               "coordinate frame whose poses it holds");
        b.text("checkpoints", checkpoints,
               "surveyed points, a prism or fixes to hold runs against");
        b.numbers("point", recording.point, "what stood over them in the body");
        b.number("points_time_offset_s", recording.points_time_offset_s,
                 config::Range::between(-9.2e9, 9.2e9), "added to their stamps");
        b.integer("first", recording.first, config::Range::non_negative(), "first frame");
        b.integer("last", recording.last, config::Range::non_negative(), "last frame, included");
      },
      kOthers);
  if (entry.path.empty() == entry.world.empty()) {
    throw plan_error(recording.origin, "either 'path' or 'simulate'",
                     entry.path.empty() ? "neither" : "both");
  }
  if (recording.last >= 0 && recording.last < recording.first) {
    throw plan_error(*document.origin("last"), "a last frame that is not before the first",
                     std::to_string(recording.last));
  }
  recording.statements_file = existing_file(document, "config", config_file, folder, missing);
  recording.reference = existing_file(document, "reference", reference, folder, missing);
  recording.checkpoints = existing_file(document, "checkpoints", checkpoints, folder, missing);
  if (!recording.point.empty() && recording.point.size() != 3) {
    throw plan_error(*document.origin("point"), "three numbers: x, y, z in the body",
                     std::to_string(recording.point.size()));
  }
  recording.statements = assignments_under(document, "statements");
  for (const Document& item : document.items("pipelines", "name")) {
    recording.pipelines.push_back(item.scalar("name").value_or(""));
  }
  for (const char* key : {"arguments", "seeds"}) {
    if (entry.world.empty() && document.has(key)) {
      throw plan_error(*document.origin(key), fmt::format("'{}' beside 'simulate' only", key),
                       "a recording that is not made");
    }
  }
  return entry;
}

std::vector<fs::path> matching(const fs::path& pattern) {
  glob_t found{};
  std::vector<fs::path> paths;
  if (::glob(pattern.c_str(), 0, nullptr, &found) == 0) {
    for (std::size_t i = 0; i < found.gl_pathc; ++i) paths.emplace_back(found.gl_pathv[i]);
  }
  ::globfree(&found);
  return paths;
}

std::string name_of_path(const fs::path& path) {
  return fs::is_directory(path) ? path.filename().string() : path.stem().string();
}

void add_recorded(const Entry& entry, const fs::path& folder,
                  std::vector<PlannedRecording>& recordings, std::vector<Missing>& missing) {
  const Origin& origin = entry.recording.origin;
  fs::path pattern = absolute_below(folder, entry.path);
  if (!pattern.has_filename()) pattern = pattern.parent_path();  // "drive/" is "drive"
  const std::vector<fs::path> paths = matching(pattern);
  if (paths.empty()) {
    missing.push_back({origin, "a recording that is there", pattern});
    return;
  }
  if (paths.size() > 1 && !entry.recording.name.empty()) {
    throw plan_error(origin, "one recording for a name",
                     fmt::format("{} that match", paths.size()));
  }
  for (const fs::path& path : paths) {
    recordings.push_back(entry.recording);
    recordings.back().path = path;
    if (entry.recording.name.empty()) recordings.back().name = name_of_path(path);
  }
}

void add_generated(const Entry& entry, const Document& document,
                   const SimulationCheck& simulation_error,
                   std::vector<PlannedRecording>& recordings) {
  PlannedRecording made = entry.recording;
  if (made.name.empty()) made.name = entry.world;
  made.generated = {entry.world, option_words(document.child("arguments"))};
  std::vector<PlannedRecording> all;
  for (const double seed : entry.seeds) {
    PlannedRecording seeded = made;
    seeded.name += fmt::format("-seed{}", seed);
    seeded.generated->arguments.insert(seeded.generated->arguments.end(),
                                       {"--seed", fmt::format("{}", seed)});
    all.push_back(std::move(seeded));
  }
  if (all.empty()) all.push_back(std::move(made));
  for (const PlannedRecording& recording : all) {
    std::vector<std::string> words{recording.generated->world};
    words.insert(words.end(), recording.generated->arguments.begin(),
                 recording.generated->arguments.end());
    if (const auto error = simulation_error(words)) {
      throw plan_error(recording.origin, "what `traverse simulate` takes", *error);
    }
  }
  recordings.insert(recordings.end(), all.begin(), all.end());
}

void check_names(const std::vector<PlannedRecording>& recordings) {
  std::map<std::string, const PlannedRecording*> names;
  for (const PlannedRecording& recording : recordings) {
    if (recording.name.empty() || recording.name.find('/') != std::string::npos) {
      throw plan_error(recording.origin, "a name without '/'", files::in_quotes(recording.name));
    }
    const auto [other, is_new] = names.emplace(recording.name, &recording);
    if (!is_new) {
      throw plan_error(recording.origin, "names that are there once (give it a 'name')",
                       fmt::format("{} again (first: line {})", files::in_quotes(recording.name),
                                   other->second->origin.line));
    }
  }
}

}  // namespace

std::vector<PlannedRecording> read_recordings(const Document& plan, const fs::path& folder,
                                              const SimulationCheck& simulation_error) {
  std::vector<PlannedRecording> recordings;
  std::vector<Missing> missing;
  for (const Document& item : plan.items("recordings", "path")) {
    const Entry entry = read_entry(item, folder, missing);
    if (entry.world.empty()) {
      add_recorded(entry, folder, recordings, missing);
    } else {
      add_generated(entry, item, simulation_error, recordings);
    }
  }
  require_none(missing);
  if (recordings.empty()) {
    throw plan_error(plan.origin("recordings").value_or(plan.origin()), "at least one recording",
                     "none");
  }
  check_names(recordings);
  return recordings;
}

}  // namespace traverse::batch
