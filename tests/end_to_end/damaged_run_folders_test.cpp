#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <string>
#include <sys/resource.h>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/sealed_json.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/loam/factor_bench.hpp"
#include "traverse/mapping/map_folder.hpp"
#include "traverse/mapping/map_origin.hpp"
#include "traverse/pipeline/run_digests.hpp"
#include "traverse/pipeline/run_folder.hpp"
#include "traverse/pipeline/run_keyframes.hpp"
#include "traverse/replay/recording.hpp"
#include "traverse/replay/session.hpp"
#include "traverse/report/compare.hpp"
#include "traverse/report/run_report.hpp"
#include "traverse/slam/loop.hpp"

#include "end_to_end/program.hpp"
#include "temporary_folder.hpp"

namespace traverse {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::run_program;
using Json = nlohmann::ordered_json;

constexpr const char* kTemplates = TRAVERSE_SOURCE_DIR "/reports/templates";

/// The commands that read a run folder, as far as they read it, in this process.
enum class Command { kReport, kCompare, kReplay, kMap, kLocalize };
constexpr std::array<std::pair<Command, const char*>, 5> kCommands{
    {{Command::kReport, "report"},
     {Command::kCompare, "compare"},
     {Command::kReplay, "replay"},
     {Command::kMap, "map"},
     {Command::kLocalize, "localize"}}};

/// A file of a run folder and the commands that cannot do without it being whole.
struct RunFile {
  const char* name;
  std::set<Command> readers;
  /// Read it too, and of folders of earlier versions without what tells whether it is whole.
  std::set<Command> lookers = {};
};

const std::vector<RunFile>& run_files() {
  using enum Command;
  static const std::vector<RunFile> kFiles{
      {"run.json", {kReport, kCompare, kReplay, kMap, kLocalize}},
      {"trajectory.tum", {kReport, kCompare, kReplay, kMap, kLocalize}},
      {"frames.csv", {kReport, kCompare, kReplay, kMap, kLocalize}},
      {"reference.tum", {kReport, kCompare}, {kReplay}},
      {"evaluation.json", {kReport, kCompare}},
      {"odometry.tum", {kReport, kCompare}},
      {"odometry_evaluation.json", {kReport, kCompare}},
      {"loops.csv", {kReport, kCompare}},
      {"map.ply", {kReport}},
      {"scan.ply", {kReport}},
      {"worst_frames.ply", {kReport}},
      {"jacobians.json", {kReport}},
      {"factor_bench.json", {kReport}},
      {"keyframes.simplemap", {kMap, kLocalize}},
      {"origin.json", {kMap}}};
  return kFiles;
}

/// A run folder with one file that is not as it was.
struct Damage {
  std::string file;
  std::string what;         ///< "cut after 12 bytes"
  std::string content;      ///< of the file
  bool is_harmful = false;  ///< whoever reads it must say so, without digests too
};

std::string read_bytes(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string replaced(std::string text, std::size_t begin, std::size_t length,
                     const std::string& by) {
  return text.replace(begin, length, by);
}

/// Where numbers stand in a text: begin and length.
std::vector<std::pair<std::size_t, std::size_t>> numbers_in(const std::string& text) {
  constexpr std::string_view kBefore = " ,:[\n";
  constexpr std::string_view kOf = "0123456789.-+e";
  std::vector<std::pair<std::size_t, std::size_t>> places;
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (kBefore.find(text[i - 1]) == std::string_view::npos) continue;
    if (text[i] != '-' && (text[i] < '0' || text[i] > '9')) continue;
    const std::size_t end = text.find_first_not_of(kOf, i);
    if (end == std::string::npos || std::isalpha(static_cast<unsigned char>(text[end])) != 0) {
      continue;
    }
    places.emplace_back(i, end - i);
    i = end;
  }
  return places;
}

/// The text with single numbers changed, at places spread over it.
void add_numbers(const std::string& file, const std::string& text, std::vector<Damage>& list) {
  constexpr std::array<const char*, 8> kNumbers{
      "-1", "1e300", "nan", "99999999999999999999", "-1e300", "4294967296", "0.5", "1e999"};
  const auto places = numbers_in(text);
  ASSERT_FALSE(places.empty()) << file;
  for (std::size_t k = 0; k < kNumbers.size(); ++k) {
    const auto [begin, length] = places[(2 * k + 1) * places.size() / (2 * kNumbers.size())];
    list.push_back({file, fmt::format("byte {} becomes {}", begin, kNumbers[k]),
                    replaced(text, begin, length, kNumbers[k])});
  }
}

/// A binary cloud with single floats changed, and with another count of points in its head.
void add_floats(const std::string& file, const std::string& bytes, std::vector<Damage>& list) {
  constexpr std::string_view kEndOfHead = "end_header\n";
  const std::size_t data = bytes.find(kEndOfHead) + kEndOfHead.size();
  for (const float value : {std::numeric_limits<float>::quiet_NaN(), 3e38F, -1.0F}) {
    for (const std::size_t share : {1U, 5U}) {
      const std::size_t at = data + (bytes.size() - data) * share / 8 / 4 * 4;
      std::string changed = bytes;
      std::memcpy(changed.data() + at, &value, sizeof value);
      list.push_back({file, fmt::format("float at byte {} becomes {}", at, value), changed});
    }
  }
  const std::string element = "element vertex ";
  const std::size_t count = bytes.find(element) + element.size();
  const std::size_t length = bytes.find('\n', count) - count;
  for (const std::string number : {"0", "7", "4000000000", "-1"}) {
    // How many points there were is known of the map alone.
    const bool is_harmful = number != "7" || file == "map.ply";
    list.push_back({file, "says that there are " + number, replaced(bytes, count, length, number),
                    is_harmful});
  }
}

void add_cuts(const std::string& file, const std::string& bytes, std::vector<Damage>& list) {
  list.push_back({file, "emptied", "", true});
  for (const std::size_t share : {1U, 2U, 3U}) {
    const std::size_t kept = bytes.size() * share / 4;
    list.push_back({file, fmt::format("cut after {} bytes", kept), bytes.substr(0, kept), true});
  }
  // The last byte of a text may be the end of its last line.
  list.push_back({file, "cut before its last byte", bytes.substr(0, bytes.size() - 1)});
}

/// JSON that is well formed and deep enough to overflow a stack.
std::string nested_setting(const std::string& record) {
  const std::string key = "\"value\":";
  const std::size_t begin = record.find(key) + key.size();
  constexpr std::size_t kLevels = 1'000'000;
  return replaced(record, begin, record.find(',', begin) - begin,
                  std::string(kLevels, '[') + std::string(kLevels, ']'));
}

double peak_memory_mb() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// What a folder tells of its files: earlier versions wrote no digests.
enum class Kind { kWithDigests, kOfEarlierVersion };

/// Two runs of two drives through one place, with loops, reference and all files that a run may
/// have; made once.
class DamagedRunFolders : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new testing::TemporaryFolder;
    for (const auto& [name, options] :
         {std::pair{"run", ""}, std::pair{"other", "--drive-seed 5"}}) {
      const auto made = run_program(
          fmt::format("simulate town_short --sensor vlp16 --first 40 --duration 2 {} -o {}.rawlog",
                      options, path(name)));
      ASSERT_EQ(made.status, 0) << made.messages;
      const auto run =
          run_program(fmt::format("run {0}.rawlog -o {0} --set slam.gnss.use=false --no-report "
                                  "--no-hash --recording name={1}",
                                  path(name), name));
      ASSERT_EQ(run.status, 0) << run.messages;
      add_what_a_short_run_lacks({path(name)});
      make_like_an_earlier_version(name);
    }
  }
  static void TearDownTestSuite() { delete folder_; }

  static void add_what_a_short_run_lacks(const pipeline::RunFolder& folder) {
    const auto keyframes = slam::read_keyframes(folder.keyframes());
    ASSERT_GE(keyframes.size(), 2U);
    const auto path =
        dataset::read_trajectory(folder.trajectory(), dataset::TrajectoryFormat::kTum);
    std::vector<slam::Loop> loops;
    for (const std::size_t keyframe : {std::size_t{1}, keyframes.size() - 1}) {
      slam::Loop loop;
      loop.keyframe = keyframe;
      loop.stamp = nearest(path, keyframes[keyframe].stamp);
      loop.candidate_stamp = nearest(path, keyframes[0].stamp);
      loop.verdict = keyframe == 1 ? slam::LoopVerdict::kAccepted : slam::LoopVerdict::kResidual;
      loops.push_back(loop);
    }
    slam::write_loops(folder.loops(), loops);
    loam::FactorBench bench;
    bench.recording = folder.path.filename();
    for (const auto& [name, derivative] : optimization::kDerivativeNames) {
      bench.evaluations.push_back({"line vector", derivative, 100, {5, 4, 6}});
      bench.solves.push_back({{"line vector", "plane signed"}, derivative, 4, {1, 1, 2}, 0, 0});
    }
    files::write_text(folder.factor_bench(), loam::to_json(bench));
    mapping::write_map_origin(folder.origin(), {48.1, 11.5, 500});
    add_to_record(folder);
  }

  /// As if the run had written these files too.
  static void add_to_record(const pipeline::RunFolder& folder) {
    Json record = record_without_seal(folder);
    std::vector<pipeline::FileDigest> digests;
    pipeline::add_digests(folder, digests);
    for (const auto& file : digests) {
      record["files"][file.name] = {{"bytes", file.bytes}, {"sha256", file.sha256}};
    }
    files::write_text(folder.record(), files::sealed_json(record.dump(1) + "\n"));
  }

  static void make_like_an_earlier_version(const std::string& name) {
    const pipeline::RunFolder folder{path(name)};
    const pipeline::RunFolder earlier{path(base(name, Kind::kOfEarlierVersion))};
    fs::create_directory(earlier.path);
    for (const auto& entry : fs::directory_iterator(folder.path)) {
      fs::create_hard_link(entry.path(), earlier.path / entry.path().filename());
    }
    Json record = record_without_seal(folder);
    record.erase("files");
    files::write_text(earlier.record(), record.dump(1) + "\n");
    Json bench = Json::parse(read_bytes(folder.factor_bench()));
    bench.erase(std::string(files::kSealKey));
    files::write_text(earlier.factor_bench(), bench.dump(1) + "\n");
  }

  static Json record_without_seal(const pipeline::RunFolder& folder) {
    Json record = Json::parse(read_bytes(folder.record()));
    record.erase(std::string(files::kSealKey));
    return record;
  }

  /// The name of the folder that holds the run.
  static std::string base(const std::string& run, Kind kind) {
    return kind == Kind::kWithDigests ? run : "earlier-" + run;
  }

  static geometry::Stamp nearest(const geometry::Trajectory& path, geometry::Stamp stamp) {
    geometry::Stamp best = path.stamps().front();
    for (const geometry::Stamp other : path.stamps()) {
      const auto apart = [&](geometry::Stamp s) {
        return std::abs(geometry::seconds_between(stamp, s));
      };
      if (apart(other) < apart(best)) best = other;
    }
    return best;
  }

  static const RunFile& file_of(const Damage& damage) {
    return *std::find_if(run_files().begin(), run_files().end(),
                         [&](const RunFile& one) { return one.name == damage.file; });
  }

  static void expect_to_help(const std::string& message, const Damage& damage,
                             const pipeline::RunFolder& folder) {
    EXPECT_THAT(message, HasSubstr(damage.file));
    EXPECT_THAT(message, HasSubstr(folder.path.string()));
    EXPECT_THAT(message, HasSubstr("expected"));
    EXPECT_THAT(message, HasSubstr("traverse run"));
    EXPECT_THAT(message, Not(HasSubstr("json.exception")));
    EXPECT_LT(message.size(), 500U);
  }

  static std::string path(const std::string& name) { return (*folder_ / name).string(); }

  /// A folder like that of the run, with the one file as `damage` says.
  static pipeline::RunFolder damaged(const Damage& damage, Kind kind = Kind::kWithDigests) {
    const pipeline::RunFolder folder{path("damaged")};
    fs::remove_all(folder.path);
    fs::create_directory(folder.path);
    for (const auto& entry : fs::directory_iterator(path(base("run", kind)))) {
      const fs::path name = entry.path().filename();
      if (name != damage.file) fs::create_hard_link(entry.path(), folder.path / name);
    }
    std::ofstream(folder.path / damage.file, std::ios::binary) << damage.content;
    return folder;
  }

  static void read(Command command, const pipeline::RunFolder& run, bool with_pictures) {
    switch (command) {
      case Command::kReport: {
        report::RunReportOptions options;
        options.pictures = with_pictures;
        options.picture_width = 320;
        report::write_run_report(run.path, kTemplates, options);
        break;
      }
      case Command::kCompare:
        report::write_comparison({path("run"), run.path}, path("compared.html"), kTemplates, {});
        break;
      case Command::kReplay: {
        dataset::OpenOptions options;
        options.share_folder = TRAVERSE_SHARE_DIR;
        const auto recording = replay::Recording::open(run.path, options);
        auto pipeline = recording.make_pipeline({}, 1);
        replay::Session session(recording.source(), std::move(pipeline.estimator),
                                recording.frame_sensor(), recording.first_frame());
        session.go_to(recording.first_frame() + 1, [](const auto&) { return true; });
        break;
      }
      case Command::kMap: {
        fs::create_directories(path("map"));
        mapping::MapOptions options;
        options.remove_moving = false;
        mapping::write_map({path("map")}, pipeline::read_map_keyframes(run.path),
                           pipeline::read_origin(run), options);
        break;
      }
      case Command::kLocalize:
        pipeline::read_localization_map(run.keyframes());
        break;
    }
  }

  /// The error that the command tells; empty: none.
  static std::string message_of(Command command, const pipeline::RunFolder& run) {
    try {
      read(command, run, false);
    } catch (const files::InputError& error) {
      return error.what();
    }
    return {};
  }

  static std::vector<Damage> damages(Kind kind) {
    std::vector<Damage> list;
    for (const RunFile& file : run_files()) {
      const std::string bytes = read_bytes(path(base("run", kind)) + "/" + file.name);
      EXPECT_FALSE(bytes.empty()) << file.name;
      add_cuts(file.name, bytes, list);
      const std::string others = read_bytes(path(base("other", kind)) + "/" + file.name);
      if (others != bytes) list.push_back({file.name, "another run's", others});
      const std::string ending = fs::path(file.name).extension();
      if (ending == ".ply") {
        add_floats(file.name, bytes, list);
      } else if (ending != ".simplemap") {
        add_numbers(file.name, bytes, list);
      }
    }
    const std::string record = read_bytes(path(base("run", kind)) + "/run.json");
    list.push_back({"run.json", "a setting nested 10^6 deep", nested_setting(record), true});
    return list;
  }

 private:
  static inline testing::TemporaryFolder* folder_ = nullptr;
};

TEST_F(DamagedRunFolders, WholeOnesAreRead) {
  for (const auto& [command, name] : kCommands) {
    for (const char* run : {"run", "other"}) {
      if (command == Command::kCompare && run == std::string("other")) continue;  // another drive
      EXPECT_EQ(message_of(command, {path(run)}), "") << name;
      EXPECT_EQ(message_of(command, {path(base(run, Kind::kOfEarlierVersion))}), "") << name;
    }
  }
}

TEST_F(DamagedRunFolders, EveryCommandNamesTheFileThatItReads) {
  const std::vector<Damage> list = damages(Kind::kWithDigests);
  ASSERT_GE(list.size(), 200U);
  std::size_t told = 0;
  const double before_mb = peak_memory_mb();
  for (const Damage& damage : list) {
    const pipeline::RunFolder folder = damaged(damage);
    const RunFile& file = file_of(damage);
    for (const auto& [command, name] : kCommands) {
      if (!file.readers.contains(command) && !file.lookers.contains(command)) continue;
      SCOPED_TRACE(fmt::format("{}, {}: {}", damage.file, damage.what, name));
      expect_to_help(message_of(command, folder), damage, folder);
      ++told;
    }
  }
  fmt::print("{} folders, {} messages, {:.0f} MB more memory\n", list.size(), told,
             peak_memory_mb() - before_mb);
}

TEST_F(DamagedRunFolders, OfEarlierVersionsEveryCommandNamesTheFileOrDoesItsWork) {
  const std::vector<Damage> list = damages(Kind::kOfEarlierVersion);
  ASSERT_GE(list.size(), 200U);
  std::size_t told = 0;
  std::size_t unseen = 0;
  const double before_mb = peak_memory_mb();
  for (const Damage& damage : list) {
    const pipeline::RunFolder folder = damaged(damage, Kind::kOfEarlierVersion);
    const RunFile& file = file_of(damage);
    const std::size_t told_before = told;
    for (const auto& [command, name] : kCommands) {
      const bool needs = file.readers.contains(command);
      if (!needs && !file.lookers.contains(command)) continue;
      SCOPED_TRACE(fmt::format("{}, {}: {}", damage.file, damage.what, name));
      const std::string message = message_of(command, folder);
      EXPECT_FALSE(needs && damage.is_harmful && message.empty()) << "it needs the file";
      if (message.empty()) continue;
      ++told;
      expect_to_help(message, damage, folder);
    }
    if (told == told_before) ++unseen;
  }
  fmt::print("{} folders, {} messages, {} read all the same, {:.0f} MB more memory\n", list.size(),
             told, unseen, peak_memory_mb() - before_mb);
}

TEST_F(DamagedRunFolders, AFileThatACommandDoesNotNeedDoesNotStopIt) {
  for (const RunFile& file : run_files()) {
    const pipeline::RunFolder folder = damaged({file.name, "emptied", ""});
    for (const auto& [command, name] : kCommands) {
      if (file.readers.contains(command) || file.lookers.contains(command)) continue;
      EXPECT_EQ(message_of(command, folder), "") << file.name << ", " << name;
    }
  }
}

TEST_F(DamagedRunFolders, EveryProgramEndsWithTheMessage) {
  const std::string simulated = path("run") + ".rawlog";
  for (const auto& [file, arguments] : std::vector<std::pair<std::string, std::string>>{
           {"map.ply", "report {0} --no-pictures"},
           {"evaluation.json", "compare {1} {0} -o {2}.html"},
           {"trajectory.tum", "evaluate {0}"},
           {"reference.tum", "evaluate {0}"},
           {"keyframes.simplemap", "map {0} -o {2}"},
           {"keyframes.simplemap", "localize {3} --map {0} -o {2}"},
           {"run.json", "report {0} --no-pictures"}}) {
    std::string bytes = read_bytes(path("run") + "/" + file);
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    const pipeline::RunFolder folder = damaged({file, "a bit flipped", bytes});
    const auto result = run_program(fmt::format(fmt::runtime(arguments), folder.path.string(),
                                                path("run"), path("result"), simulated));
    SCOPED_TRACE(arguments);
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.messages, HasSubstr("traverse: " + (folder.path / file).string()));
    EXPECT_FALSE(fs::exists(path("result"))) << "nothing was made of it";
    EXPECT_FALSE(fs::exists(path("result.html")));
  }
}

TEST_F(DamagedRunFolders, WhatIsReadAllTheSameCanBeDrawn) {
  const std::set<std::string> drawn{"evaluation.json", "frames.csv", "loops.csv",
                                    "map.ply",         "scan.ply",   "worst_frames.ply"};
  for (const Damage& damage : damages(Kind::kOfEarlierVersion)) {
    if (!drawn.contains(damage.file)) continue;
    const pipeline::RunFolder folder = damaged(damage, Kind::kOfEarlierVersion);
    if (!message_of(Command::kReport, folder).empty()) continue;
    SCOPED_TRACE(damage.file + ", " + damage.what);
    EXPECT_NO_THROW(read(Command::kReport, folder, true));
  }
}

TEST_F(DamagedRunFolders, FilesThatAreNotAlwaysThereMayBeAbsent) {
  for (const char* name : {"reference.tum", "loops.csv", "map.ply", "scan.ply", "worst_frames.ply",
                           "jacobians.json", "factor_bench.json"}) {
    const pipeline::RunFolder folder = damaged({name, "gone", ""});
    fs::remove(folder.path / name);
    EXPECT_EQ(message_of(Command::kReport, folder), "") << name;
    EXPECT_EQ(message_of(Command::kReplay, folder), "") << name;
  }
}

}  // namespace
}  // namespace traverse
